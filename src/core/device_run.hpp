#pragma once
// Running a device ahead of the host: batches of recorded steps until its clock halts.

#include <chrono>
#include <cmath>

#include "core/step_clock.hpp"
#include "exec/step_graph.hpp"

namespace breccia {

/// What the host knows of time.
struct HostTimes {
  double &time, &last_dt, &next_dt;
  std::int64_t& step;
};

/// Starts the device's clock at the host's time.
inline void start_clock(Buffer<StepClock>& clock, const HostTimes& host, const StopAt& stop) {
  StepClock start;
  start.now = {host.time, host.last_dt, host.next_dt};
  start.step = host.step;
  start.stop = stop;
  start.least = ordered_bits(largest_least);
  clock.resize(1);
  copy_bytes(clock.data(), clock.space(), &start, Space::host, sizeof start);
}

/// Reads it back; adds the steps it has counted.
inline StepClock read_clock(const Buffer<StepClock>& clock, const HostTimes& host,
                            Advanced& taken) {
  StepClock c;
  copy_bytes(&c, Space::host, clock.data(), clock.space(), sizeof c);
  host.time = c.now.time;
  host.last_dt = c.now.last_dt;
  host.next_dt = c.now.next_dt;
  if (c.step > host.step) {
    taken.dt_min = taken.steps > 0 ? smaller(taken.dt_min, c.dt_min) : c.dt_min;
    taken.dt_max = larger(taken.dt_max, c.dt_max);
    taken.steps += c.step - host.step;
  }
  host.step = c.step;
  return c;
}

/// Steps that are launched one by one and many at a time.
struct StepGraphs {
  StepGraph one, many;
  static constexpr std::int64_t many_steps = 16;

  bool stale() const { return one.empty() && many.empty(); }
  void clear() {
    one.clear();
    many.clear();
  }
};

/// Takes steps on a device until `stop`, or until about `slice` has passed.
///
/// @param launch_step  launches all kernels of one step, the last of them FinishStep
/// @param finish_step  what the host does when the clock halts in the middle of a step, told why:
/// the
///                     rest of that step; it clears `graphs` if arrays have moved
template <class LaunchStep, class FinishOnHost>
Advanced run_ahead(Buffer<StepClock>& clock, StepGraphs& graphs, const HostTimes& host,
                   const StopAt& stop, const LaunchStep& launch_step,
                   const FinishOnHost& finish_step) {
  constexpr std::chrono::milliseconds slice{50};
  constexpr double longest_batch = 3.0 * StepGraphs::many_steps;
  const auto begin = std::chrono::steady_clock::now();
  Advanced taken;
  start_clock(clock, host, stop);
  for (;;) {
    const double to_time = std::ceil((stop.time - host.time) / host.next_dt);
    const double to_step = static_cast<double>(stop.step - host.step);
    auto steps =
        static_cast<std::int64_t>(smaller(longest_batch, larger(1.0, smaller(to_time, to_step))));
    for (; steps >= StepGraphs::many_steps; steps -= StepGraphs::many_steps) {
      if (graphs.many.empty())
        graphs.many.record([&] {
          for (int i = 0; i < StepGraphs::many_steps; ++i) launch_step();
        });
      graphs.many.replay();
    }
    if (steps > 0 && graphs.one.empty()) graphs.one.record(launch_step);
    for (; steps > 0; --steps) graphs.one.replay();
    const StepClock now = read_clock(clock, host, taken);
    if (now.wanted != 0) {
      finish_step(now.wanted);
      host.step += 1;
      taken.dt_min = taken.steps > 0 ? smaller(taken.dt_min, host.last_dt) : host.last_dt;
      taken.dt_max = larger(taken.dt_max, host.last_dt);
      ++taken.steps;
      start_clock(clock, host, stop);
    }
    if (host.time >= stop.time || host.step >= stop.step) return taken;
    if (std::chrono::steady_clock::now() - begin > slice) return taken;
  }
}

}  // namespace breccia
