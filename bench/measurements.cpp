#include "bench/measurements.hpp"

#include <algorithm>
#include <chrono>

#include "exec/memory.hpp"

namespace breccia {

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Measurement once(const std::string& part, const std::string& name, double value, const char* unit) {
  return {part, name, unit, value, value, value};
}

Measurement over_windows(const std::string& part, const std::string& name, const char* unit,
                         std::vector<double> values, double factor) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  const double median = 0.5 * (values[(n - 1) / 2] + values[n / 2]);
  return {part, name, unit, factor * median, factor * values.front(), factor * values.back()};
}

Measurement arrays_at_most(const std::string& part, Space space, const std::string& item,
                           double count) {
  return once(part, "peak_arrays_per_" + item, static_cast<double>(peak_array_bytes(space)) / count,
              "B");
}

}  // namespace breccia
