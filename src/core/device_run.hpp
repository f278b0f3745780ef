#pragma once
// Running a device ahead of the host: steps are launched a few at a time until its clock halts.

#include <chrono>
#include <cmath>
#include <optional>

#include "core/stepping.hpp"
#include "core/timed.hpp"
#include "exec/device.hpp"
#include "exec/launch_times.hpp"
#include "exec/shadow_launches.hpp"
#include "exec/step_graph.hpp"

namespace breccia {

/// Time as the host keeps it.
struct HostTimes {
  double &time, &last_dt, &next_dt;
  std::int64_t& step;
};

/// The clocks of one step of a recorded few.
struct StepClocks {
  const StepClock* before;
  StepClock* now;

  template <class Kernel, class Rule>
  FirstLaunch<Kernel, Rule> opening(const Kernel& kernel, const EndOfStep<Rule>& end,
                                    bool keeps) const {
    return {kernel, end, before, now, keeps};
  }
  template <Phase phase, class Kernel>
  ClockedLaunch<Kernel, phase> timed(const Kernel& kernel) const {
    return {kernel, now};
  }
};

/// Wraps kernels to run at once, with the times that they are made with.
struct AtOnce {
  template <class Kernel>
  PlainLaunch<Kernel> operator()(const Kernel& kernel) const {
    return PlainLaunch(kernel);
  }
};
/// Wraps kernels to be led by the clock of a step.
template <Phase phase>
struct ByClock {
  StepClocks clocks;
  template <class Kernel>
  ClockedLaunch<Kernel, phase> operator()(const Kernel& kernel) const {
    return clocks.timed<phase>(kernel);
  }
};

/// Parts of a step that have no launch where a device's clock leads. One device holds all: it has
/// no ghosts. When a search is due the clock halts. The first launch of the next step advances
/// time, chooses the step and counts it.
struct ClockLed {
  template <class World>
  void send_ghosts(World&) const {}
  template <class World>
  void move_interior(World&) const {}
  template <class World>
  void ask_for_search(World&) const {}
  template <class World>
  void inner_joint_forces(World&) const {}
  template <class World>
  void receive_ghosts(World&) const {}
  template <class World>
  void search_if_due(World&) const {}
  template <class World>
  void choose_step(World&) const {}
  template <class World>
  void count_step(World&) const {}
};

/// Starts the device's clocks at the host's time, before a step or after its move.
template <class Rule>
void start_clock(Buffer<StepClock>& clock, const EndOfStep<Rule>& end, const HostTimes& host,
                 const StopAt& stop, std::int32_t open) {
  StepClock start[2];
  start[0].open = open;
  start[0].to_evaluation = start[1].to_evaluation = end.to_evaluation(host.step);
  start[0].now = start[1].now = {host.time, host.last_dt, host.next_dt, host.step};
  start[0].stop = start[1].stop = stop;
  start[0].least = start[1].least = ordered_bits(largest_least);
  clock.resize(2);
  copy_bytes(clock.data(), clock.space(), start, Space::host, sizeof start);
}

/// Takes the time of a clock over; adds the steps it has counted.
template <class Rule>
StepClock count_steps(StepClock c, const EndOfStep<Rule>& end, const HostTimes& host,
                      Advanced& taken) {
  end(c);
  host.time = c.now.time;
  host.last_dt = c.now.last_dt;
  host.next_dt = c.now.next_dt;
  if (c.now.step > host.step) {
    taken.dt_min = taken.steps > 0 ? min(taken.dt_min, c.dt_min) : c.dt_min;
    taken.dt_max = max(taken.dt_max, c.dt_max);
    taken.steps += c.now.step - host.step;
  }
  host.step = c.now.step;
  return c;
}
/// Reads the first clock back.
template <class Rule>
StepClock read_clock(const Buffer<StepClock>& clock, const EndOfStep<Rule>& end,
                     const HostTimes& host, Advanced& taken) {
  StepClock c;
  copy_bytes(&c, Space::host, clock.data(), clock.space(), sizeof c);
  return count_steps(c, end, host, taken);
}

/// How long a step takes, by what the host sees of a device that runs ahead, and what follows from
/// it: how many steps are launched before they have begun, and whether they are recorded.
class RunningAhead {
 public:
  static constexpr std::int64_t few = 4;  ///< steps of a graph: even; its first clock is the last

  /// @param pace  StepGraph::pace
  explicit RunningAhead(double& pace) : pace_(pace) {}
  /// Steps have begun after a halt.
  void begin() { begun_ = Clock::now(); }
  /// So many have been taken since.
  void see(std::int64_t steps) {
    if (steps >= few)
      pace_ =
          std::chrono::duration<double>(Clock::now() - begun_).count() / static_cast<double>(steps);
  }
  /// Enough to bridge the host's absence; the fewer, the fewer are let pass after a halt, which
  /// read nearly as much as steps do. At least two: the next step counts the one before.
  std::int64_t ahead() const {
    if (is_long()) return 2;
    if (!(pace_ > 0.0)) return most;
    const double steps = std::ceil(absence / (pace_ * few)) * few;
    return steps < static_cast<double>(most) ? static_cast<std::int64_t>(steps) : most;
  }
  /// Whether steps are recorded. Where they take longer than to launch them, a record pays only
  /// where it is repeated often.
  bool records(std::int64_t launched) const {
    return !is_long() && (pace_ < slow_step || launched >= 64);
  }
  /// Whether a record is replayed.
  bool replays() const { return !is_long(); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::int64_t most = 12;
  static constexpr double absence = 2e-4, slow_step = 4e-5;  // [s]
  bool is_long() const { return pace_ > absence; }
  Clock::time_point begun_;
  double& pace_;
};

/// Takes steps on a device until `stop`, or until about `slice` has passed.
///
/// @param launch_step  launches all kernels of one step by its StepClocks; the first one is
///                     Opening. If it takes a truth, too: whether the host has ended the step
///                     before
/// @param launch_forces_only  launches those after the move, wrapped as before it: the clock starts
/// there
/// @param on_halt      what the host does when the clock halts in the middle of a step, told why:
///                     the rest of that step too if it returns true; it clears `graph` if arrays
///                     have moved
template <class Rule, class LaunchStep, class LaunchForcesOnly, class OnHalt>
Advanced run_ahead(Buffer<StepClock>& clock, StepGraph& graph, const EndOfStep<Rule>& end,
                   const HostTimes& host, const StopAt& stop, const LaunchStep& launch_step,
                   const LaunchForcesOnly& launch_forces_only, const OnHalt& on_halt) {
  constexpr std::chrono::milliseconds slice{50};
  const auto begin = std::chrono::steady_clock::now();
  RunningAhead running(graph.pace);
  const auto late = [&] { return std::chrono::steady_clock::now() - begin > slice; };
  const bool shadow = clock.space() == Space::shadow;
  constexpr bool is_told = std::is_invocable_v<LaunchStep, const StepClocks&, bool>;
  const auto launch_one = [&](const StepClocks& clocks, bool follows_host) {
    if constexpr (is_told)
      launch_step(clocks, follows_host);
    else
      launch_step(clocks);
  };
  const auto launch_two = [&](bool follows_host) {
    StepClock* const c = clock.data();
    launch_one(StepClocks{c, c + 1}, follows_host);
    launch_one(StepClocks{c + 1, c}, false);
  };
  Advanced taken;
  std::int32_t open = 0;
  for (;;) {
    start_clock(clock, end, host, stop, open);
    std::optional<ShadowLaunches> launches;
    if (shadow) launches.emplace();
    if (open != 0) launch_forces_only(StepClocks{nullptr, clock.data()});
    const double needed = min(std::ceil((stop.time - host.time) / host.next_dt),
                              static_cast<double>(stop.step - host.step));
    running.begin();
    for (std::int64_t launched = 0, seen = 0; static_cast<double>(launched) < needed;) {
      if (launched - seen < (LaunchTimes::wanted() ? 2 : running.ahead())) {
        const bool follows_host = is_told && launched == 0 && open == 0;
        if (LaunchTimes::wanted()) {  // a graph has none
          launch_two(follows_host);
          if (!shadow) wait_for_device();
          launched += 2;
          continue;
        }
        const bool by_hand =
            !shadow && (graph.empty() ? !running.records(launched) : !running.replays());
        if (follows_host || by_hand) {
          launch_two(follows_host);
          launched += 2;
          continue;
        }
        if (graph.empty())
          graph.record(clock.space(), [&] {
            for (std::int64_t i = 0; i < RunningAhead::few; i += 2) launch_two(false);
          });
        graph.replay();
        launched += RunningAhead::few;
        continue;
      }
      StepClock c;
      peek_bytes(&c, clock.data(), clock.space(), sizeof c);
      seen = c.now.step - host.step;
      running.see(seen);
      if (c.halted != 0 || late()) break;
    }
    launches.reset();
    const StepClock now = read_clock(clock, end, host, taken);
    open = 0;
    if (now.host_request != 0) {
      if (on_halt(now.host_request)) {
        host.step += 1;
        taken.dt_min = taken.steps > 0 ? min(taken.dt_min, host.last_dt) : host.last_dt;
        taken.dt_max = max(taken.dt_max, host.last_dt);
        ++taken.steps;
      } else {
        open = step_open_after_move;
        continue;
      }
    }
    if (host.time >= stop.time || host.step >= stop.step || late()) return taken;
  }
}

}  // namespace breccia
