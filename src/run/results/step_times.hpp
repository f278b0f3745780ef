#pragma once
// How long steps take: median and percentiles of any number of steps in constant memory.

#include <array>
#include <cstdint>

namespace breccia {

/// A histogram of durations whose classes grow by 1 %, from 10 ns to more than an hour: a quantile
/// is exact to 0.5 %.
class StepTimes {
 public:
  /// So many steps that took so long each.
  void add(double seconds, std::int64_t steps = 1);
  /// The duration that `share` (0 to 1) of all steps do not exceed; 0 if there are none.  [s]
  double quantile(double share) const;
  std::int64_t count() const { return count_; }

 private:
  static constexpr double shortest = 1e-8;  ///<  [s]
  static constexpr double growth = 1.01;
  static constexpr int classes = 2700;  // shortest * growth^2700 = 4700 s
  std::array<std::int64_t, classes> counts_{};
  std::int64_t count_ = 0;
};

}  // namespace breccia
