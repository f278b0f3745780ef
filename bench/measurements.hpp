#pragma once
// Measurements of benchmarks: windows of equal work, and their median.

#include <functional>
#include <string>
#include <vector>

#include "bench/benchmark.hpp"
#include "exec/space.hpp"

namespace breccia {

inline constexpr int window_count = 7;

/// Wall time of some work.  [s]
double seconds_of(const std::function<void()>& work);

Measurement once(const std::string& part, const std::string& name, double value, const char* unit);

/// Median, least and most of the windows' values, times `factor`.
Measurement over_windows(const std::string& part, const std::string& name, const char* unit,
                         std::vector<double> values, double factor);

/// The most that arrays of a space have taken since their peak was last forgotten, over `count`
/// items of a model.
Measurement arrays_at_most(const std::string& part, Space space, const std::string& item,
                           double count);

}  // namespace breccia
