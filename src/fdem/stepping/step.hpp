#pragma once
// How the step of the FDEM (fdem_shared/step.hpp) is carried out: by HostRun in loops over packs,
// by launches of a device (device_run.cpp), at once or recorded and led by the device's clock.

#include "fdem/world.hpp"
#include "fdem_shared/step.hpp"
#include "fdem_shared/stepwise_run.hpp"

namespace breccia::fdem {

using fdem_shared::take_forces;
using fdem_shared::take_step;

/// Fluid that flows and bolts that pull, besides what both shapes share.
struct StepwiseRun : fdem_shared::StepwiseRun<World> {
  void load_forces(World& w) const;
};

/// Corners that move as one share their force anew, after some have got more of it.
void share_bundle_forces(World& w);

/// Loops on the host, over packs, shared by threads.
struct HostRun : fdem_shared::MovingRun<StepwiseRun, World> {
  /// While ghosts travel: forces of joints that act on none of them. Only of those that are whole
  /// and stay so, since a search reads how joints are damaged and may be due.
  void inner_joint_forces(World& w) const;
  void pair_forces(World& w) const;
  void sum_forces(World& w);

  // Parts of pair_forces().
  void joint_forces(World& w) const;  ///< those that have not gone ahead
  void couple_forces(World& w) const;
};

/// One step by launches at once: on the GPUs of ranks. The host's text, the device's kernels.
void take_step_on_device(World& w);
/// Evaluates the forces and chooses the step that follows, by launches at once.
void take_forces_on_device(World& w);
/// As many steps as a few hundredths of a second hold, launched ahead and led by the device's
/// clock.
Advanced advance_on_device(World& w, const StopAt& stop);

}  // namespace breccia::fdem
