// Ghosts follow their owners: the work of ranks in each step (dem/ranks.hpp).

#include "domain/ghosts.hpp"

#include "dem/ranks.hpp"

namespace breccia::dem {

void start_ghosts(World& w) {
  breccia::start_ghosts(w, w.elements.state);
}
void finish_ghosts(World& w) {
  breccia::finish_ghosts(w, w.elements.state);
}
void refresh_ghosts(World& w) {
  breccia::refresh_ghosts(w, w.elements.state);
}

void select_active_ghosts(World& w) {
  // On a device the list costs more than it saves.
  if (w.domain.single_rank() || w.exec.space != Space::host) return;
  w.domain.select_active_ghosts(w.elements.id, w.contacts.pairs.a, w.contacts.pairs.b);
}

}  // namespace breccia::dem
