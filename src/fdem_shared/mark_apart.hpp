#pragma once
// Which elements are summed apart (summed_apart.hpp).

#include "core/select.hpp"
#include "exec/for_each.hpp"
#include "fdem_shared/exposed.hpp"
#include "fdem_shared/shape.hpp"
#include "fdem_shared/summed_apart.hpp"

namespace breccia::fdem_shared {

/// Marks the groups of elements that supports hold, or of which a corner moves with others.
template <Index corners>
struct MarkHeldAndRinged {
  static constexpr const char* name = "fdem.mark_apart";
  View<const Index> hold;
  View<const std::uint8_t> ringed;  ///< of corners; empty: none is
  View<std::uint8_t> marked;
  BR_HD void operator()(Index t) const {
    bool apart = hold[t] >= 0;
    for (Index k = 0; k < corners && ringed.size > 0; ++k)
      apart = apart || ringed[corners * t + k] != 0;
    if (apart) set_flag(marked, t / apart_group);
  }
};
/// Marks those of elements that loads act on.
template <class LoadedSide>
struct MarkLoaded {
  static constexpr const char* name = "fdem.mark_loaded";
  View<const LoadedSide> sides;
  View<std::uint8_t> marked;
  BR_HD void operator()(Index i) const { set_flag(marked, sides[i].element() / apart_group); }
};
struct IsMarked {
  View<const std::uint8_t> marked;
  BR_HD bool operator()(Index g) const { return marked[g] != 0; }
};

/// Lists SummedApart.
template <class World>
void list_apart(World& w, Index groups) {
  using Shape = ShapeOf<World>;
  SummedApart& apart = w.summed_apart;
  const Index elements = Shape::elements(w).size();
  apart.marked.resize_unfilled(groups);
  clear_bytes(apart.marked.data(), w.exec.space, static_cast<std::size_t>(groups));
  for_each(w.exec, elements,
           MarkHeldAndRinged<Shape::corners>{std::as_const(Shape::elements(w).hold).view(),
                                             std::as_const(w.ringed).view(), apart.marked.view()});
  if (w.load_starts.size() > 1)
    for_each(w.exec, Shape::loaded_sides(w).size(),
             MarkLoaded<typename Shape::LoadedSide>{std::as_const(Shape::loaded_sides(w)).view(),
                                                    apart.marked.view()});
  apart.group = items_where(w.exec, groups, IsMarked{std::as_const(apart.marked).view()});
  apart.known = true;
  w.graph.clear();
}

/// From so many elements on a sum and a move at one go pays. On a GPU few elements wait longer for
/// the longer chain of both than for a launch more (bench/notes/gpu.md). Tests in Space::shadow see
/// both ways.
inline Index fewest_moved_at_once(Space space) {
  return space == Space::cuda ? 200'000 : space == Space::shadow ? 100 : 1;
}

/// Whether other elements than those that are summed apart are worth a sum and a move at one go.
/// Lists SummedApart, if it is not known.
template <class World>
bool world_moves_most_at_once(World& w) {
  const Index elements = ShapeOf<World>::elements(w).size();
  if (elements < fewest_moved_at_once(w.exec.space)) return false;
  const Index groups = (elements + apart_group - 1) / apart_group;
  if (!w.summed_apart.known || w.summed_apart.marked.size() != groups) list_apart(w, groups);
  return w.summed_apart.leaves_most();
}

}  // namespace breccia::fdem_shared
