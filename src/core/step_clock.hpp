#pragma once
// Time on a GPU: kernels read it there, so that many steps run without the host.
//
// The host launches steps ahead. When something needs it (a search is due, the end is reached), the
// device halts: kernels of all later steps do nothing, until the host has done its part and starts
// the clock anew.

#include <cstdint>
#include <limits>
#include <type_traits>

#include "exec/buffer.hpp"
#include "math/vec.hpp"

namespace breccia {

/// When steps end: at the first one at or past a time, or at a number of steps.
struct StopAt {
  double time = 1e300;                                           ///<  [s]
  std::int64_t step = std::numeric_limits<std::int64_t>::max();  ///< since the start of the case
};

/// Steps that were taken at one go.
struct Advanced {
  std::int64_t steps = 0;
  double dt_min = 0.0, dt_max = 0.0;  ///< among them  [s]
};

/// What kernels see of time.
struct Moment {
  double time;              ///< of the positions  [s]
  double last_dt, next_dt;  ///< the step that led there, the step to come  [s]
};

/// The clock of a device.
struct StepClock {
  Moment now{};
  std::int64_t step = 0;
  StopAt stop;
  double dt_min = 1e300, dt_max = 0.0;  ///< of the steps since the clock was started  [s]
  std::uint64_t least = 0;              ///< bits of the smallest number noted in this step
  std::int32_t wanted = 0;              ///< the host is wanted after the move of this step
  std::int32_t halted = 0;
};

/// The bits of a number that is not negative: they are ordered like the numbers.
BR_HD inline std::uint64_t ordered_bits(double number) {
  std::uint64_t bits = 0;
  __builtin_memcpy(&bits, &number, sizeof bits);
  return bits;
}
BR_HD inline double number_of(std::uint64_t bits) {
  double number = 0.0;
  __builtin_memcpy(&number, &bits, sizeof number);
  return number;
}
inline constexpr double largest_least = 1e300;  ///< where `least` starts in every step

/// Rounds a time step down to six bits: noise in the stiffest element's last bits must not change
/// every step after it.
BR_HD inline double rounded_down(double dt) {
  return number_of(ordered_bits(dt) & ~((std::uint64_t{1} << 47) - 1));
}

/// The least number that all threads have noted.
BR_HD inline double least_noted(const StepClock& clock) {
#if defined(__CUDA_ARCH__)
  return number_of(__ldcg(reinterpret_cast<const unsigned long long*>(&clock.least)));  // past L1
#else
  return number_of(clock.least);
#endif
}

/// A kernel of the part of a step before the elements have moved, or after it, by the device's
/// clock. `Kernel::set(Moment)` gives it the time.
template <class Kernel, bool moved>
struct Timed {
  Kernel kernel;
  View<const StepClock> clock;

  BR_HD auto operator()(Index i) const {
    using Result = decltype(kernel(i));
    const StepClock& c = clock[0];
    if (c.halted != 0 || (moved && c.wanted != 0)) {
      if constexpr (std::is_void_v<Result>)
        return;
      else
        return Result{largest_least};
    }
    Kernel timed = kernel;
    if constexpr (moved)
      timed.set(Moment{c.now.time + c.now.next_dt, c.now.next_dt, c.now.next_dt});
    else
      timed.set(c.now);
    return timed(i);
  }
};
template <bool moved, class Kernel>
Timed<Kernel, moved> timed(const Kernel& kernel, const Buffer<StepClock>& clock) {
  return {kernel, clock.view()};
}

/// The last kernel of a step, of one item. `Rule` gives the step to come from the least number that
/// was noted and the last step.
template <class Rule>
struct FinishStep {
  static constexpr const char* name = "core.finish_step";
  Rule rule;
  int evaluate_every;
  View<StepClock> clock;

  static constexpr double neutral = largest_least;
  /// The clock keeps the least of all that threads note.
  BR_HD void note([[maybe_unused]] double number) const {
#if defined(__CUDA_ARCH__)
    auto* const least = reinterpret_cast<unsigned long long*>(&clock[0].least);
    const unsigned long long bits = ordered_bits(number);
    if (bits < __ldcg(least)) atomicMin(least, bits);
#endif
  }
  BR_HD void operator()(Index) const {
    StepClock& c = clock[0];
    if (c.halted != 0) return;
    c.now.time += c.now.next_dt;
    c.now.last_dt = c.now.next_dt;
    if (c.wanted != 0) {
      c.halted = 1;
      return;
    }
    if (c.step % evaluate_every == 0) c.now.next_dt = rule(least_noted(c), c.now.last_dt);
    c.least = ordered_bits(largest_least);
    c.step += 1;
    c.dt_min = smaller(c.dt_min, c.now.last_dt);
    c.dt_max = larger(c.dt_max, c.now.last_dt);
    if (c.now.time >= c.stop.time || c.step >= c.stop.step) c.halted = 1;
  }
};

}  // namespace breccia
