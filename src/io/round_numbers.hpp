#pragma once
// Numbers and units as people write them on axes.

#include <string>
#include <vector>

#include "io/picture/picture.hpp"

namespace breccia {

/// The largest of 1, 2 or 5 times a power of ten that is not above `value` > 0.
double round_step_below(double value);

/// A unit with a prefix that brings `largest` between 0.1 and 1000: shown = value * factor.
struct ScaledUnit {
  double factor;
  std::string unit;  ///< "kN"; "1e-6 kg" where a prefix makes no sense; "" for "-"
};
ScaledUnit scaled_unit(const std::string& unit, double largest);

/// A mark on a colour bar.
struct Tick {
  double value;
  std::string text;  ///< of value times factor
};
/// About five ticks at round numbers within the range.
std::vector<Tick> ticks_of(const ValueRange& range, double factor);
/// The range widened to round numbers; a range of no width becomes one of some width.
ValueRange rounded_outwards(const ValueRange& range);
/// The range, or where its values are the rounding of nothing (stresses below 1 Pa, forces below
/// 1 uN, lengths below 1e-12 m, velocities below 1e-9 m/s) one up to that size.
ValueRange beyond_rounding(const ValueRange& range, const std::string& unit);

/// A time with its unit, "1.206 ms"; a length likewise, "200 mm".
std::string time_text(double seconds);
std::string length_text(double metres);
/// A count with commas: "14,274".
std::string count_text(double count);

}  // namespace breccia
