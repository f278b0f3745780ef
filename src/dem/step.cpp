#include "dem/ranks.hpp"

namespace breccia::dem {

void step(World& w) {
  // 1. Newton's laws: accelerations, velocities, positions              (Durand 2012, section 4.4)
  move_awaited(w);
  start_copies(w);  // on other ranks: they follow while all others move,
  move_others(w);
  ask_for_search(w);  // and all ranks vote

  // 2. New contacts, when travel has used the margin up: grid, sort, search         (section 4.3)
  finish_copies(w);
  if (contacts_are_due(w)) {
    refresh_copies(w);
    find_contacts(w);
  }

  // 3. One force per interaction, then one sum per element: no atomics              (section 4.2)
  //    Links and contacts that end here mark themselves.
  // 4. The next step: min over elements of sqrt(inertia / stiffness)                (section 4.4)
  evaluate_forces(w);
  w.step += 1;
}

Advanced advance(World& w, const StopAt& stop) {
  if (w.exec.space != Space::host && w.domain.alone()) return advance_on_device(w, stop);
  step(w);
  return {1, w.last_dt, w.last_dt};
}

void evaluate_forces(World& w) {
  if (w.exec.space != Space::host) {
    forces_on_device(w);
  } else {
    bar_forces(w);
    contact_forces(w);
    concrete_forces_and_sums(w);
  }
  wall_forces(w);
  if (w.step % w.parameters.time.evaluate_every == 0) w.next_dt = choose_time_step(w);
}

}  // namespace breccia::dem
