#pragma once
// Elements whose corners feel more than the sum of their own forces: supports, loads or other
// corners act on them, too. All others can be moved as soon as their forces are summed up.
//
// Elements are told apart by groups of 32, which a warp of a device takes together. Tetrahedra are
// all summed up before they move: there is more to compute than to read (bench/notes/tried.md).

#include "exec/buffer.hpp"
#include "exec/early.hpp"

namespace breccia::fdem_shared {

/// Elements of a group.
inline constexpr Index apart_group = 32;

/// Listed when a step asks for them. Another stage, loads on other sides, other corners that move
/// as one, and ranks make the list unknown.
struct SummedApart {
  Buffer<std::uint8_t> marked;  ///< 1: of a group that holds such an element  [-]
  Buffer<Index> group;          ///< these groups, ascending  [-]
  bool known = false;

  Index threads() const { return group.size() * apart_group; }
  /// Whether enough others are left for a sum and a move at one go.
  bool leaves_most() const { return 2 * group.size() <= marked.size(); }
};

/// Whether elements of a world move as their forces are summed up.
template <class World>
inline constexpr bool moves_at_once = requires(World& w) {
  w.summed_apart;
};

/// Who else acts on elements has changed.
template <class World>
void forget_apart(World& w) {
  if constexpr (moves_at_once<World>) w.summed_apart.known = false;
}

/// A view of SummedApart::marked.
struct ApartView {
  View<const std::uint8_t> marked;
  BR_HD bool operator()(Index t) const { return read_now(&marked[t / apart_group]) != 0; }
};

}  // namespace breccia::fdem_shared
