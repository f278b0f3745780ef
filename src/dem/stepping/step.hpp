#pragma once
// The step of the DEM: the only text of the order of its work.
//
// A run carries it out: HostRun by loops over packs, DeviceRun by launches, at once or recorded and
// led by the device's clock. A run groups kernels into loops or launches; it never reorders them.

#include <optional>

#include "dem/world.hpp"
#include "exec/shadow_launches.hpp"

namespace breccia::dem {

/// All elements where they are at the end of the step, and the contacts that they may have there.
template <class Run>
void take_motion(Run&& run, World& w) {
  // 1. Newton's laws: accelerations, velocities, positions                          (section 4.4)
  run.move_boundary(w);  // on one rank: all of them
  run.send_ghosts(w);    // while the interior moves
  run.move_interior(w);
  run.receive_ghosts(w);

  // 2. New contacts, when travel has used the margin up: grid, sort, search         (section 4.3)
  run.search_if_due(w);
}

/// Forces at the time of the positions, and the step that follows.
template <class Run>
void take_forces(Run&& run, World& w) {
  // 3. One force per interaction, then one sum per element: no atomics              (section 4.2)
  //    Links and contacts that end here mark themselves. The host evaluates concrete links inside
  //    sum_forces, tile by tile.
  run.pair_forces(w);
  run.sum_forces(w);
  run.coupling_forces(w);  // of what another method adds: coupled/step.cpp
  run.wall_forces(w);

  // 4. The next step: min over elements of sqrt(inertia / stiffness)                (section 4.4)
  run.choose_step(w);
}

/// One step of the scheme of Durand et al. 2012, Figure 1 and section 3.3.
template <class Run>
void take_step(Run&& run, World& w) {
  take_motion(run, w);
  take_forces(run, w);
  run.count_step(w);
}

/// The step that all elements allow where they are, after some have been set free. All ranks call
/// it; the world stays as it is.  [s]
double step_allowed_now(const World& w);

/// Critical numbers of the state as it is, which do not go along when elements are shared out. All
/// ranks call it; the rest of the world stays as it is.
void find_critical(World& w);

/// Forces of the state as it is, after what links and contacts bear has changed between two steps.
/// All ranks call it.
void evaluate_anew(World& w);

/// Parts that all runs of one step at a time share: ghosts, the search, the time step.
struct StepwiseRun {
  void send_ghosts(World& w) const;
  void receive_ghosts(World& w) const;
  void search_if_due(World& w) const;
  void coupling_forces(World&) const {}
  void wall_forces(World& w) const;
  void choose_step(World& w) const;
  void count_step(World& w) const { w.step += 1; }
};

/// Loops on the host, over packs, shared by threads.
struct HostRun : StepwiseRun {
  void move_boundary(World& w) const;
  void move_interior(World& w) const;
  void pair_forces(World& w) const;
  void sum_forces(World& w) const;
};

/// Launches at once, of a device.
class DeviceRun : public StepwiseRun {
 public:
  void move_boundary(World& w) const;
  void move_interior(World& w) const;
  void pair_forces(World& w);
  void sum_forces(World& w);

 private:
  std::optional<ShadowLaunches> launches_;
};

/// One step by launches at once: on the GPUs of ranks. The host's text, the device's kernels.
void take_step_on_device(World& w);
/// Evaluates the forces and chooses the step that follows, by launches at once.
void take_forces_on_device(World& w);
/// As many steps as a few hundredths of a second hold, launched ahead and led by the device's
/// clock.
Advanced advance_on_device(World& w, const StopAt& stop);

}  // namespace breccia::dem
