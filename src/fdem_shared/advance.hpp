#pragma once
// Steps of the FDEM one after the other, until someone looks at the state.

#include <algorithm>
#include <chrono>

#include "core/stepping.hpp"
#include "fdem_shared/step.hpp"
#include "fdem_shared/stepping.hpp"

namespace breccia::fdem_shared {

/// Steps up to `stop`, or as many as a tenth of a second holds, but four. A step that another one
/// follows leaves sums of forces to the move of that one.
template <class HostRun, class World>
Advanced advance_on_host(World& w, const StopAt& stop) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds slice{100};
  constexpr std::int64_t few = 4;
  const Clock::time_point begin = Clock::now();
  HostRun run;
  Advanced taken;
  do {
    const bool is_last = taken.steps + 1 >= few && Clock::now() - begin > slice;
    if (!is_last) run.until = stop;
    if (is_last) run.until = {0.0, 0};
    take_step(run, w);
    taken.dt_min = taken.steps == 0 ? w.last_dt : std::min(taken.dt_min, w.last_dt);
    taken.dt_max = std::max(taken.dt_max, w.last_dt);
    ++taken.steps;
  } while (run.sums_due);
  return taken;
}

/// Steps up to `stop` or less, on the host or on a device.
template <class HostRun, class World>
Advanced advance_world(World& w, const StopAt& stop) {
  // Places of cracks, bolts and axes are of the host in every step, on a device, too.
  if (w.given->flow.on || !w.given->bolts.empty() || turns_anything(w)) {
    step(w);
    return {1, w.last_dt, w.last_dt};
  }
  if constexpr (moves_at_once<World>)
    if (w.exec.space == Space::host) return advance_on_host<HostRun>(w, stop);
  return advance_by_steps(w, stop);
}

}  // namespace breccia::fdem_shared
