#pragma once
// Kernels by the clock of a device: what every launch of a step wraps its kernels in.

#include <type_traits>

#include "core/step_clock.hpp"

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
    if (c.wanted != 0) {
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
    c.dt_min = smaller(c.dt_min, c.now.last_dt);
    c.dt_max = larger(c.dt_max, c.now.last_dt);
    if (c.now.time >= c.stop.time || c.now.step >= c.stop.step) c.halted = 1;
  }
};

/// The type that a wrapped kernel reads ahead, if it has one.
template <class Kernel>
struct Ahead {};
template <class Kernel>
requires requires {
  typename Kernel::Ready;
}
struct Ahead<Kernel> {
  using Ready = typename Kernel::Ready;
};

/// A kernel of the first launch of a step: ends the step before.
template <class Kernel, class Rule>
struct Opening : Ahead<Kernel> {
  Kernel kernel;
  EndOfStep<Rule> end;
  const StepClock* before;  ///< the clock that the step before has kept
  StepClock* clock;         ///< of this step
  bool keeps;               ///< of all kernels of the launch, this one's item 0 writes the clock

  Opening(const Kernel& of, const EndOfStep<Rule>& rule, const StepClock* from, StepClock* to,
          bool writes)
      : kernel(of), end(rule), before(from), clock(to), keeps(writes) {}

  template <class Read>
  BR_HD void prepare(Index i, Read& ready) const {
    kernel.prepare(i, ready);
  }
  template <class... Read>
  BR_HD void operator()(Index i, Read&... ready) const {
    (kernel.fetch(i, ready), ...);  // before the clock is known
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
      if (c.halted != 0) clock->wanted = c.wanted;  // or a thread of this launch may set it
    }
    if (c.halted != 0) return;
    Kernel timed = kernel;
    timed.set(c.now);
    timed(i, ready...);
  }
};

/// Where in a step a launch stands: in its move; after that, where it stays out if the host is
/// wanted; or there with the move in the clock's time already.
enum class Stand { in_move, after_move, in_rest };

#if defined(__CUDACC__)
#define BR_RARELY __host__ __device__ __noinline__
#else
#define BR_RARELY __attribute__((noinline))
#endif

/// Keeps what a pointer leads to where the launch has it: otherwise all of it is passed by value.
template <class T>
BR_HD inline void stay_in_place([[maybe_unused]] const T*& parameters) {
#if defined(__CUDA_ARCH__)
  asm volatile("" : "+l"(parameters));
#endif
}

/// work(kernel, i) as of `now`, in a function of its own: what few items need costs the others no
/// registers.
/// @param kernel  where the launch has its parameters: see Timed
template <class Kernel, class Work>
BR_RARELY void rarely(const Kernel* kernel, Moment now, Index i, Work work) {
  stay_in_place(kernel);
  Kernel timed = *kernel;
  timed.set(now);
  work(timed, i);
}

/// A kernel of any launch but the first. `Kernel::set(Moment)` gives a copy of it the time. One
/// that hands its own address on gets the time by `at_moment`: its parameters stay in place.
template <class Kernel, Stand stand>
struct Timed : Ahead<Kernel> {
  Kernel kernel;
  const StepClock* clock;

  Timed(const Kernel& of, const StepClock* by) : kernel(of), clock(by) {}

  template <class Read>
  BR_HD void prepare(Index i, Read& ready) const {
    kernel.prepare(i, ready);
  }
  template <class... Read>
  BR_HD auto operator()(Index i, Read&... ready) const {
    using Result = decltype(kernel(i, ready...));
    (kernel.fetch(i, ready), ...);  // before the clock is known
    const StepClock& c = *clock;
    if (c.halted != 0 || (stand != Stand::in_move && c.wanted != 0)) {
      if constexpr (std::is_void_v<Result>)
        return;
      else
        return Result{largest_least};
    }
    const Moment now = stand == Stand::after_move ? Moment{c.now.time + c.now.next_dt,
                                                           c.now.next_dt, c.now.next_dt, c.now.step}
                                                  : c.now;
    if constexpr (requires { kernel.at_moment(now, i, ready...); }) {
      return kernel.at_moment(now, i, ready...);
    } else {
      Kernel timed = kernel;
      timed.set(now);
      return timed(i, ready...);
    }
  }
};

/// Empty kernel as a barrier: later kernels may read ahead, as all earlier ones have completed.
struct Fence {
  static constexpr const char* name = "core.fence";
  BR_HD void set(const Moment&) {}
  BR_HD void operator()(Index) const {}
};

/// A kernel of a step that the host takes by itself, with the times that it was made with.
template <class Kernel>
struct AtOnce : Ahead<Kernel> {
  Kernel kernel;

  explicit AtOnce(const Kernel& of) : kernel(of) {}

  template <class Read>
  BR_HD void prepare(Index i, Read& ready) const {
    kernel.prepare(i, ready);
  }
  template <class... Read>
  BR_HD auto operator()(Index i, Read&... ready) const {
    (kernel.fetch(i, ready), ...);
    return kernel(i, ready...);
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
