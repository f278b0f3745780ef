#include "fdem/ranks.hpp"

namespace breccia::fdem {

void step(World& w) {
  // 1. Newton's second law: velocities and positions of all corners      (Lukas 2014, section 2)
  move_awaited(w);
  start_copies(w);  // on other ranks: they follow while all others move,
  move_others(w);
  ask_for_search(w);      // all ranks vote,
  inner_joint_forces(w);  // and what needs no copies goes ahead

  // 2. Contact detection, when travel has used the margin up or a joint has opened
  finish_copies(w);
  if (couples_are_due(w)) {
    refresh_copies(w);
    find_couples(w);
  }

  // 3. Joints appear and crack, couples push and rub, triangles deform; one sum per corner, no
  // atomics
  // 4. The next step: Gershgorin's bound
  evaluate_forces(w);
  w.step += 1;
}

Advanced advance(World& w, const StopAt& stop) {
  if (w.exec.space != Space::host && w.domain.alone()) return advance_on_device(w, stop);
  step(w);
  return {1, w.last_dt, w.last_dt};
}

void evaluate_forces(World& w) {
  insert_joints(w);
  if (w.exec.space != Space::host) {
    forces_on_device(w);
  } else {
    joint_forces(w);
    couple_forces(w);
    triangle_forces(w);
  }
  load_forces(w);
  if (w.step % w.parameters.time.evaluate_every == 0) w.next_dt = choose_time_step(w);
}

}  // namespace breccia::fdem
