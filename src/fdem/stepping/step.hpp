#pragma once
// How the step of the FDEM (fdem_shared/step.hpp) is carried out: by HostRun in loops over packs,
// by DeviceRun in launches, at once or recorded and led by the device's clock.

#include "fdem/world.hpp"
#include "fdem_shared/step.hpp"

namespace breccia::fdem {

using fdem_shared::take_forces;
using fdem_shared::take_step;

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
