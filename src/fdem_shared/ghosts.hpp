#pragma once
// Ghosts follow their owners: the work of ranks in each step, text of fdem_shared/ranks.hpp. Made
// for each method in its stepping/ghosts.cpp.

#include "domain/ghosts.hpp"
#include "fdem_shared/ranks.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

template <class World>
void start_ghosts(World& w) {
  breccia::start_ghosts(w, ShapeOf<World>::elements(w).nodes);
}
template <class World>
void finish_ghosts(World& w) {
  breccia::finish_ghosts(w, ShapeOf<World>::elements(w).nodes);
}
template <class World>
void refresh_ghosts(World& w) {
  breccia::refresh_ghosts(w, ShapeOf<World>::elements(w).nodes);
}

template <class World>
void select_active_ghosts(World& w) {
  // On a device the list costs more than it saves.
  if (w.domain.single_rank() || w.exec.space != Space::host || ShapeOf<World>::needs_all_ghosts(w))
    return;
  w.domain.select_active_ghosts(ShapeOf<World>::elements(w).id, w.couples.pairs.a,
                                w.couples.pairs.b);
}

}  // namespace breccia::fdem_shared
