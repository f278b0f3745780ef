#pragma once
// The step of the FDEM, with triangles or tetrahedra: the only text of the order of its work.
//
// A run carries it out, of either method: HostRun by loops, DeviceRun by launches, ClockedRun by
// launches that are recorded and led by the device's clock (stepwise_run.hpp, host_run.hpp,
// device_run.hpp). A run groups kernels into loops or launches; it never reorders them.

namespace breccia::fdem_shared {

/// All elements where they are at the end of the step, and the couples that may touch there.
template <class Run, class World>
void take_motion(Run&& run, World& w) {
  // 1. Newton's second law: velocities and positions of all corners
  run.move_boundary(w);
  run.send_ghosts(w);  // while the interior moves,
  run.move_interior(w);
  run.ask_for_search(w);      // all ranks vote,
  run.inner_joint_forces(w);  // and what needs no ghosts goes ahead
  run.receive_ghosts(w);

  // 2. Contact detection, when travel has used the margin up or a joint has opened
  run.search_if_due(w);
}

/// Forces at the time of the positions, and the step that follows.
template <class Run, class World>
void take_forces(Run&& run, World& w) {
  // 3. Joints appear and crack, couples push and rub, elements deform; one sum per corner, no
  //    atomics
  run.insert_joints(w);
  run.pair_forces(w);
  run.sum_forces(w);
  run.coupling_forces(w);  // of what another method adds: coupled/step.cpp
  run.load_forces(w);
  run.bundle_forces(w);

  // 4. The next step: Gershgorin's bound
  run.choose_step(w);
}

/// One step: the points of Lukas 2014, section 2.
template <class Run, class World>
void take_step(Run&& run, World& w) {
  take_motion(run, w);
  take_forces(run, w);
  run.count_step(w);
}

}  // namespace breccia::fdem_shared
