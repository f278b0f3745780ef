#pragma once
// The step of the FDEM: the only text of the order of its work.
//
// A run carries it out: HostRun by loops over packs, DeviceRun by launches, at once or recorded and
// led by the device's clock. A run groups kernels into loops or launches; it never reorders them.

#include "fdem/world.hpp"

namespace breccia::fdem {

/// Forces at the time of the positions, and the step that follows.
template <class Run>
void take_forces(Run&& run, World& w) {
  // 3. Joints appear and crack, couples push and rub, triangles deform; one sum per corner, no
  //    atomics
  run.insert_joints(w);
  run.pair_forces(w);
  run.sum_forces(w);
  run.load_forces(w);
  run.bundle_forces(w);

  // 4. The next step: Gershgorin's bound
  run.choose_step(w);
}

/// One step: the points of Lukas 2014, section 2.
template <class Run>
void take_step(Run&& run, World& w) {
  // 1. Newton's second law: velocities and positions of all corners
  run.move_boundary(w);
  run.send_ghosts(w);  // while the interior moves,
  run.move_interior(w);
  run.ask_for_search(w);      // all ranks vote,
  run.inner_joint_forces(w);  // and what needs no ghosts goes ahead
  run.receive_ghosts(w);

  // 2. Contact detection, when travel has used the margin up or a joint has opened
  run.search_if_due(w);

  take_forces(run, w);
  run.count_step(w);
}

/// Parts that all runs of one step at a time share: ghosts, the search, insertion, loads, the time
/// step.
struct StepwiseRun {
  void send_ghosts(World& w) const;
  void ask_for_search(World& w) const;
  void inner_joint_forces(World&) const {}
  void receive_ghosts(World& w) const;
  void search_if_due(World& w) const;
  void insert_joints(World& w) const;
  void load_forces(World& w) const;
  /// Corners that move as one share their force.
  void bundle_forces(World& w) const;
  void choose_step(World& w) const;
  void count_step(World& w) const { w.step += 1; }
};

/// Corners that move as one share their force anew, after some have got more of it.
void share_bundle_forces(World& w);

/// Loops on the host, over packs, shared by threads.
struct HostRun : StepwiseRun {
  void move_boundary(World& w) const;
  void move_interior(World& w) const;
  /// While ghosts travel: forces of joints that act on none of them. Only of those that are whole
  /// and stay so, since a search reads how joints are damaged and may be due.
  void inner_joint_forces(World& w) const;
  void pair_forces(World& w) const;
  void sum_forces(World& w) const;

  // Parts of pair_forces().
  void joint_forces(World& w) const;  ///< those that have not gone ahead
  void couple_forces(World& w) const;
};

/// One step by launches at once: on the GPUs of ranks. The host's text, the device's kernels.
void take_step_on_device(World& w);
/// Forces and the step that follows, likewise.
void take_forces_on_device(World& w);
/// As many steps as a few hundredths of a second hold, launched ahead and led by the device's
/// clock.
Advanced advance_on_device(World& w, const StopAt& stop);

}  // namespace breccia::fdem
