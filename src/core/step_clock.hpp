#pragma once
// Time on a GPU: kernels read it there, so that many steps run without the host.
//
// The host launches steps ahead. When something needs it (a search is due, the end is reached), the
// device halts: kernels of all later steps do nothing, until the host has done its part and starts
// the clock anew.

#include <cstdint>
#include <limits>

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

/// Time as kernels see it.
struct StepTime {
  double time;              ///< of the positions  [s]
  double last_dt, next_dt;  ///< the step that led there, the step to come  [s]
  std::int64_t step = 0;    ///< steps taken before, since the start of the case
  bool evaluates = true;    ///< whether the critical step is found at the end of this one
};

/// Values of StepClock::open: the current step is not finalised; it began at the move / after the
/// search.
inline constexpr std::int32_t step_open = 1, step_open_after_move = 2;

/// The clock of a device. It has two: each step reads one, as the step before left it, and keeps
/// the other, so that the first launch of a step can end the step before.
struct StepClock {
  StepTime now{};
  StopAt stop;
  double dt_min = 1e300, dt_max = 0.0;  ///< of the steps since the clock was started  [s]
  std::uint64_t least = 0;              ///< bits of the smallest number noted in this step
  std::int32_t host_request = 0;        ///< the host is host_request after the move of this step
  std::int32_t halted = 0;
  std::int32_t to_evaluation = 0;  ///< steps until one whose least number counts
  std::int32_t open = 0;           ///< step_open...: a step was taken and has not been counted yet

  /// Time as the forces of the open step see it, once its move is made.
  BR_HD StepTime after_move() const {
    return {now.time + now.next_dt, now.next_dt, now.next_dt, now.step, to_evaluation == 0};
  }
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

}  // namespace breccia
