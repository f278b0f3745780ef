#pragma once
// Kernels by the clock of a device: what every launch of a step wraps its kernels in.

#include <type_traits>

#include "core/kernel.hpp"

namespace breccia {

/// Ends the step that a clock holds open: counts it and chooses the next. `Rule` gives the step to
/// come from the least number that was noted and the last step.
template <class Rule>
struct EndOfStep {
  Rule rule;
  int evaluate_every;

  /// Steps from `step` on until one is evaluated: those whose number is a multiple.
  std::int32_t to_evaluation(std::int64_t step) const {
    const auto past = static_cast<std::int32_t>(step % evaluate_every);
    return past == 0 ? 0 : evaluate_every - past;
  }
  BR_HD void operator()(StepClock& c) const {
    if (c.halted != 0 || c.open == 0) return;
    if (c.open == step_open) {  // or its move is in the host's time already
      c.now.time += c.now.next_dt;
      c.now.last_dt = c.now.next_dt;
    }
    c.open = 0;
    if (c.host_request != 0) {
      c.halted = 1;
      return;
    }
    if (c.to_evaluation == 0) {  // counted: all items of a launch do this, and remainders cost
      c.now.next_dt = rule(number_of(c.least), c.now.last_dt);
      c.to_evaluation = evaluate_every;
    }
    c.to_evaluation -= 1;
    c.least = ordered_bits(largest_least);
    c.now.step += 1;
    c.dt_min = min(c.dt_min, c.now.last_dt);
    c.dt_max = max(c.dt_max, c.now.last_dt);
    if (c.now.time >= c.stop.time || c.now.step >= c.stop.step) c.halted = 1;
  }
};

/// A kernel of the first launch of a step: ends the step before.
template <class Kernel, class Rule>
struct FirstLaunch : LoadedBy<Kernel> {
  Kernel kernel;
  EndOfStep<Rule> end;
  const StepClock* before;  ///< the clock that the step before has kept
  StepClock* clock;         ///< of this step
  bool keeps;               ///< of all kernels of the launch, this one's item 0 writes the clock

  FirstLaunch(const Kernel& of, const EndOfStep<Rule>& rule, const StepClock* from, StepClock* to,
              bool writes)
      : kernel(of), end(rule), before(from), clock(to), keeps(writes) {}

  template <class Read>
  BR_HD void load_early(Index i, Read& loaded) const {
    kernel.load_early(i, loaded);
  }
  template <class... Read>
  BR_HD void operator()(Index i, Read&... loaded) const {
    (kernel.load_late(i, loaded), ...);  // before the clock is known
    StepClock c = *before;
    end(c);
    c.open = c.halted == 0 ? step_open : 0;
    if (keeps && i == 0) {
      clock->now = c.now;
      clock->stop = c.stop;
      clock->dt_min = c.dt_min;
      clock->dt_max = c.dt_max;
      clock->least = c.least;
      clock->to_evaluation = c.to_evaluation;
      clock->halted = c.halted;
      clock->open = c.open;
      if (c.halted != 0)
        clock->host_request = c.host_request;  // or a thread of this launch may set it
    }
    if (c.halted != 0) return;
    Kernel timed = kernel;
    timed.set(c.now);
    finish_item(timed, i, loaded...);
  }
};

/// Where in a step a launch stands: in its move; after that, where it stays out if the host is
/// host_request; or there with the move in the clock's time already.
enum class Phase { in_move, after_move, after_search };

/// The request in spite of which a kernel goes on, as its own items make it; 0: none.
template <class Kernel>
inline constexpr std::int32_t goes_on_at = 0;
template <class Kernel>
requires requires {
  Kernel::goes_on_at_request;
}
inline constexpr std::int32_t goes_on_at<Kernel> = Kernel::goes_on_at_request;

/// A kernel of any launch but the first. A copy of it gets the time, unless it hands its own
/// address on: the parameters of one with slow() or update_at(now, i, loaded) stay in place.
template <class Kernel, Phase phase>
struct ClockedLaunch : LoadedBy<Kernel> {
  Kernel kernel;
  const StepClock* clock;

  ClockedLaunch(const Kernel& of, const StepClock* by) : kernel(of), clock(by) {}

  template <class Read>
  BR_HD void load_early(Index i, Read& loaded) const {
    kernel.load_early(i, loaded);
  }
  template <class... Read>
  BR_HD auto operator()(Index i, Read&... loaded) const {
    (kernel.load_late(i, loaded), ...);  // before the clock is known
    const StepClock& c = *clock;
    if (c.halted != 0 ||
        (phase != Phase::in_move && c.host_request != 0 && c.host_request != goes_on_at<Kernel>)) {
      if constexpr (gives_number<Kernel, Read...>)
        return largest_least;
      else
        return;
    }
    StepTime now = phase == Phase::after_move ? c.after_move() : c.now;
    now.evaluates = c.to_evaluation == 0;
    if constexpr (HasSlow<Kernel>) {
      bool done = false;
      if constexpr (requires { kernel.update_at(now, i, loaded...); })
        done = kernel.update_at(now, i, loaded...);
      else
        done = kernel.update(i, loaded...);
      if (!done) run_slow(&kernel, now, i);
    } else if constexpr (requires { kernel.update_at(now, i, loaded...); }) {
      kernel.update_at(now, i, loaded...);
    } else {
      Kernel timed = kernel;
      timed.set(now);
      if constexpr (gives_number<Kernel, Read...>)
        return finish_item(timed, i, loaded...);
      else
        finish_item(timed, i, loaded...);
    }
  }
};

/// Empty kernel as a barrier: later kernels may read ahead, as all earlier ones have completed.
struct Fence {
  static constexpr const char* name = "core.fence";
  BR_HD void set(const StepTime&) {}
  BR_HD void operator()(Index) const {}
};

/// A kernel of a step that the host takes by itself, with the times that it was made with.
template <class Kernel>
struct PlainLaunch : LoadedBy<Kernel> {
  Kernel kernel;

  explicit PlainLaunch(const Kernel& of) : kernel(of) {}

  template <class Read>
  BR_HD void load_early(Index i, Read& loaded) const {
    kernel.load_early(i, loaded);
  }
  template <class... Read>
  BR_HD auto operator()(Index i, Read&... loaded) const {
    (kernel.load_late(i, loaded), ...);
    if constexpr (HasSlow<Kernel>) {
      if (!kernel.update(i, loaded...)) kernel.slow(i);
    } else if constexpr (gives_number<Kernel, Read...>) {
      return finish_item(kernel, i, loaded...);
    } else {
      finish_item(kernel, i, loaded...);
    }
  }
};

/// The clock keeps the least of all numbers that threads note. None is negative.
struct NoteLeast {
  StepClock* clock;
  static constexpr double neutral = largest_least;

  BR_HD void operator()(double number) const {
#if defined(__CUDA_ARCH__)
    auto* const least = reinterpret_cast<unsigned long long*>(&clock->least);
    const unsigned long long bits = ordered_bits(number);
    if (bits < __ldcg(least)) atomicMin(least, bits);
#else
    const std::uint64_t bits = ordered_bits(number);
    if (bits < clock->least) clock->least = bits;
#endif
  }
};

}  // namespace breccia
