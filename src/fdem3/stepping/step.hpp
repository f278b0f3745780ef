#pragma once
// How the step of the FDEM (fdem_shared/step.hpp) is carried out with tetrahedra: by HostRun in
// loops, by launches of a device (device_run.cpp), at once or recorded and led by the device's
// clock.

#include "fdem3/world.hpp"
#include "fdem_shared/step.hpp"
#include "fdem_shared/stepwise_run.hpp"

namespace breccia::fdem3 {

using fdem_shared::take_forces;
using fdem_shared::take_step;

/// Fluid that flows and bolts that pull, besides what both shapes share.
struct StepwiseRun : fdem_shared::StepwiseRun<World> {
  void load_forces(World& w) const;
};

/// Loops on the host, shared by threads.
struct HostRun : fdem_shared::MovingRun<StepwiseRun, World> {
  void pair_forces(World& w) const;
  void sum_forces(World& w);
};

struct Launches;
/// Launches at once, of a device.
using DeviceRun = fdem_shared::DeviceRunOf<Launches, StepwiseRun, World>;

/// One step by launches at once: on the GPUs of ranks. The host's text, the device's kernels.
void take_step_on_device(World& w);
/// Forces and the step that follows, likewise.
void take_forces_on_device(World& w);
/// As many steps as a few hundredths of a second hold, launched ahead and led by the device's
/// clock.
Advanced advance_on_device(World& w, const StopAt& stop);

}  // namespace breccia::fdem3
