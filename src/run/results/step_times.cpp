#include "run/results/step_times.hpp"

#include <algorithm>
#include <cmath>

namespace breccia {

void StepTimes::add(double seconds, std::int64_t steps) {
  const double position = std::log(std::max(seconds, shortest) / shortest) / std::log(growth);
  counts_[static_cast<std::size_t>(std::min(position, classes - 1.0))] += steps;
  count_ += steps;
}

double StepTimes::quantile(double share) const {
  if (count_ == 0) return 0.0;
  const auto rank = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(count_)));
  std::int64_t seen = 0;
  std::size_t found = 0;
  while (found + 1 < counts_.size() && (seen += counts_[found]) < std::max<std::int64_t>(rank, 1))
    ++found;
  return shortest * std::pow(growth, static_cast<double>(found) + 0.5);
}

}  // namespace breccia
