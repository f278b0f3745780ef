#pragma once
// Readings of probes for both methods: sum and range of a quantity over items.

#include <string>

#include "core/energy.hpp"
#include "core/quantity.hpp"

namespace breccia {

/// Sum and range of a quantity; nothing read yet. The same bits in any order.
struct Readings {
  ExactSum sum;
  double low = 1e300, high = -1e300;
  Index low_at = -1, high_at = -1;  ///< where they were read; of equal numbers the last one
  Index count = 0;

  Readings() = default;
  /// @param at  number of the item in the whole model
  BR_HD Readings(double value, Index at)
      : sum(value), low(value), high(value), low_at(at), high_at(at), count(1) {}

  /// By the word of the case: min, max, sum or mean.
  double reduced(const std::string& word) const {
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
  return a;
}

}  // namespace breccia
