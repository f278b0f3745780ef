#pragma once
// Readings of probes for both methods: sum and range of a quantity over items.

#include <functional>
#include <string>
#include <vector>

#include "core/energy.hpp"
#include "core/quantity.hpp"

namespace breccia {

/// The columns of history.csv that every run has, before those of probes.
inline constexpr const char* history_columns[] = {
    "step",    "time",     "dt",      "kinetic", "elastic", "fracture",
    "plastic", "friction", "damping", "contact", "work",    "error_relative"};

/// Sum and range of a quantity; nothing read yet. The same bits in any order.
struct Readings {
  ExactSum sum;
  double low = 1e300, high = -1e300;
  Index low_at = -1, high_at = -1;  ///< where they were read; of equal numbers the last one
  Index count = 0;
  ExactSum weight;  ///< of what is in the sum; 0: each item counts alike

  Readings() = default;
  /// @param at  number of the item in the whole model
  BR_HD Readings(double value, Index at)
      : sum(value), low(value), high(value), low_at(at), high_at(at), count(1) {}

  /// An item that counts by its weight.
  BR_HD static Readings weighted(double value, double weight, Index at) {
    Readings one(value, at);
    one.sum = ExactSum(value * weight);
    one.weight = ExactSum(weight);
    return one;
  }

  /// By the word of the case: min, max, sum or mean. Nothing read gives 0.
  double reduced(const std::string& word) const {
    const double whole = weight.value();
    if (whole > 0.0) {
      if (word == "mean") return sum.value() / whole;
    } else if (count == 0) {
      return 0.0;
    }
    if (word == "min") return low;
    if (word == "max") return high;
    return word == "sum" ? sum.value() : sum.value() / static_cast<double>(count);
  }
};
BR_HD inline Readings operator+(Readings a, const Readings& b) {
  a.sum.add(b.sum);
  if (!(a.low < b.low || (a.low == b.low && a.low_at > b.low_at))) {
    a.low = b.low;
    a.low_at = b.low_at;
  }
  if (!(a.high > b.high || (a.high == b.high && a.high_at > b.high_at))) {
    a.high = b.high;
    a.high_at = b.high_at;
  }
  a.count += b.count;
  a.weight.add(b.weight);
  return a;
}

/// The readings of a probe at the present state, when they are asked for: until then the host can
/// go on.
using ReadingsLater = std::function<Readings()>;

struct ProbeConfig;
/// Problems of a probe's quantity and of how it is read, as sentences.
/// @param of  the bearer that it reads: elements in space or in the plane, or a wall
std::vector<std::string> probe_problems(const ProbeConfig& probe, Bearer of, std::size_t axes = 0);

}  // namespace breccia
