#pragma once
// Where a step is carried out, alike for all methods: on the host by loops, on a device by
// launches. A method has take_step(run, w) and take_forces(run, w), which order the work, a
// HostRun, and for devices take_step_on_device, take_forces_on_device and advance_on_device.

#include "core/step_clock.hpp"
#include "exec/space.hpp"
#include "math/pack.hpp"

namespace breccia {

/// Whether steps by launches are compiled. The program without GPUs leaves them out; tests take
/// them in Space::shadow.
#if defined(BR_NO_LAUNCHES)
constexpr bool has_launches = false;
#else
constexpr bool has_launches = true;
#endif

/// The time step from the least stable step of all triangles: it falls at once, when something
/// comes near, and grows slowly.
struct AllowedStep {
  double safety, max_step;  ///< share of the stable step  [-], limit  [s]

  BR_HD double operator()(double least, double last_dt) const {
    double dt = min(safety * least, max_step);
    if (last_dt > 0.0) dt = min(dt, 1.05 * last_dt);
    return rounded_down(dt);
  }
};
template <class HostRun, class World>
void step_by(World& w) {
  if constexpr (has_launches)
    if (w.exec.space != Space::host) return take_step_on_device(w);
  take_step(HostRun{}, w);
}

template <class HostRun, class World>
void evaluate_forces_by(World& w) {
  if constexpr (has_launches)
    if (w.exec.space != Space::host) return take_forces_on_device(w);
  take_forces(HostRun{}, w);
}

/// One step; on a device that holds all of a world, as many as advance_on_device() takes.
template <class World>
Advanced advance_by_steps(World& w, const StopAt& stop) {
  if constexpr (has_launches)
    if (w.exec.space != Space::host && w.domain.single_rank()) return advance_on_device(w, stop);
  step(w);
  return {1, w.last_dt, w.last_dt};
}

/// The time of positions, when all of them have moved.
template <class World>
void advance_time(World& w) {
  w.time += w.next_dt;
  w.last_dt = w.next_dt;
}

}  // namespace breccia
