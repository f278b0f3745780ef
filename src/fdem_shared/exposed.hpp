#pragma once
// Where joints have opened: flags that their kernel sets, vertices that become contact-active, and
// what a rank knows of the whole mesh.

#include <vector>

#include "exec/buffer.hpp"

namespace breccia::fdem_shared {

/// Flags for the host: 0, a joint has softened; 1, a joint has broken.
enum Change : Index { change_softened = 0, change_broken = 1 };

/// Whether the vertices that touch must be marked anew in this step.
BR_HD inline bool marking_due(std::uint8_t softened, std::uint8_t broken, std::int64_t step) {
  constexpr std::int64_t every = 32;
  return broken != 0 || (softened != 0 && step % every == 0);
}

/// Sets a flag that several items may set.
BR_HD inline void set_flag(const View<std::uint8_t>& flags, Index flag) {
#if defined(__CUDA_ARCH__)
  flags[flag] = 1;
#else
  __atomic_store_n(&flags[flag], std::uint8_t{1}, __ATOMIC_RELAXED);
#endif
}
/// Whichever item does it first.
BR_HD inline void raise(const View<std::uint8_t>& flags, Change change) {
  set_flag(flags, change);
}

/// Bits of ExposedVertices::vertex: a joint here is damaged; or, only where none is, one may be
/// before the next search (open_vertices.hpp).
inline constexpr std::uint8_t vertex_damaged = 1, vertex_expected = 2;

/// Where joints have opened. A vertex becomes contact-active at a step fixed by the physics, not at
/// the next search, so results do not depend on when searches happen.
struct ExposedVertices {
  Buffer<std::uint8_t>
      changed;                  ///< flags of Change since the last marking  [-]  (2; pairs, search)
  Buffer<std::uint8_t> vertex;  ///< vertex_damaged, vertex_expected, or 0  [-]  (vertices; search)
};

/// Data of the whole mesh that a rank has besides its part.
struct WholeMesh {
  Buffer<Index> joint_number;      ///< of the local joints in the whole mesh, ascending
  std::vector<std::uint8_t> tied;  ///< 1: some corners at this vertex move as one, or did
  bool loaded = false;             ///< some sides bear loads, or may
  bool bundled = false;            ///< there are such vertices
  bool absorbs = false;            ///< some sides take waves up
  bool preset = false;             ///< joints keep an opening at which they were joined
};

}  // namespace breccia::fdem_shared
