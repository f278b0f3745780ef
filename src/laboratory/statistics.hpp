#pragma once
// Mean and scatter of repeated measurements.

#include <string>
#include <vector>

namespace breccia::laboratory {

struct Spread {
  double mean = 0.0;
  double deviation = 0.0;  ///< of the sample: root of the sum of squares over n - 1; 0 for n = 1
  int n = 0;               ///< values that are finite numbers
};

/// Of the finite ones among the values.
Spread spread_of(const std::vector<double>& values);

/// "3.12 +- 0.04 (3)": four significant digits, the deviation from two values on, their number in
/// brackets; "-" of none.
std::string spread_text(const Spread& spread, double factor = 1.0);

/// A number with four significant digits.
std::string short_number(double value);

}  // namespace breccia::laboratory
