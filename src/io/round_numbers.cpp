#include "io/round_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace breccia {
namespace {

/// The largest power of ten not above `value`, by multiplication: the same on every machine.
double power_of_ten_below(double value) {
  double power = 1.0;
  while (power * 10.0 <= value) power *= 10.0;
  while (power > value && power > 1e-300) power /= 10.0;
  return power;
}

bool takes_prefix(const std::string& unit) {
  constexpr std::array units{"m",    "N",   "Pa",  "J",   "W",    "s", "m/s",
                             "m/s2", "N m", "N/m", "J/m", "J/m2", "Hz"};
  return std::find(units.begin(), units.end(), unit) != units.end();
}

double tick_step(const ValueRange& range) {
  return round_step_below((range.high - range.low) / 3.9);
}

}  // namespace

double round_step_below(double value) {
  if (!(value > 0.0) || !std::isfinite(value)) return 1.0;
  const double power = power_of_ten_below(value);
  const double share = value / power * (1.0 + 1e-9);
  return share >= 5.0 ? 5.0 * power : share >= 2.0 ? 2.0 * power : power;
}

ScaledUnit scaled_unit(const std::string& unit, double largest) {
  const std::string plain = unit == "-" ? "" : unit;
  if (!(largest > 0.0) || (largest >= 0.0999 && largest < 1e4)) return {1.0, plain};
  if (!takes_prefix(unit)) {
    if (largest >= 1e-3 && largest < 1e5) return {1.0, plain};
    const double power = power_of_ten_below(largest);
    return {1.0 / power, fmt::format("{:.0e}{}{}", power, plain.empty() ? "" : " ", plain)};
  }
  struct Prefix {
    const char* name;
    double size;
  };
  constexpr std::array prefixes{Prefix{"G", 1e9}, Prefix{"M", 1e6},  Prefix{"k", 1e3},
                                Prefix{"", 1.0},  Prefix{"m", 1e-3}, Prefix{"u", 1e-6},
                                Prefix{"n", 1e-9}};
  for (const Prefix& prefix : prefixes) {
    if (largest >= 0.9999 * prefix.size) return {1.0 / prefix.size, prefix.name + plain};
  }
  return {1e9, "n" + plain};
}

std::vector<Tick> ticks_of(const ValueRange& range, double factor) {
  const double step = tick_step({factor * range.low, factor * range.high});
  int decimals = 0;
  for (double digit = step; digit < 0.999 && decimals < 12; digit *= 10.0) ++decimals;
  std::vector<Tick> ticks;
  const double first = std::ceil(factor * range.low / step - 1e-6);
  const double last = std::floor(factor * range.high / step + 1e-6);
  for (double number = first; number <= last && ticks.size() < 20; number += 1.0) {
    const double value = number == 0.0 ? 0.0 : number * step;
    ticks.push_back({value / factor, fmt::format("{:.{}f}", value, decimals)});
  }
  return ticks;
}

ValueRange rounded_outwards(const ValueRange& range) {
  double low = range.low, high = range.high;
  if (!(high > low)) {
    const double width = low == 0.0 ? 1.0 : 0.1 * std::fabs(low);
    high = low + width;
    if (low != 0.0) low -= width;
  }
  const double step = tick_step({low, high});
  return {step * std::floor(low / step + 1e-6), step * std::ceil(high / step - 1e-6)};
}

ValueRange beyond_rounding(const ValueRange& range, const std::string& unit) {
  const double least = unit == "Pa"    ? 1.0
                       : unit == "N"   ? 1e-6
                       : unit == "m"   ? 1e-12
                       : unit == "m/s" ? 1e-9
                                       : 0.0;
  const double largest = std::max(std::fabs(range.low), std::fabs(range.high));
  if (largest == 0.0 || largest >= least) return range;
  return {range.low < 0.0 ? -least : 0.0, least};
}

std::string time_text(double seconds) {
  const double size = std::fabs(seconds);
  if (size == 0.0) return "0 s";
  if (size >= 0.9999) return fmt::format("{:.4g} s", seconds);
  if (size >= 0.9999e-3) return fmt::format("{:.4g} ms", 1e3 * seconds);
  return fmt::format("{:.4g} us", 1e6 * seconds);
}

std::string length_text(double metres) {
  if (metres >= 0.9999) return fmt::format("{:.4g} m", metres);
  if (metres >= 0.9999e-3) return fmt::format("{:.4g} mm", 1e3 * metres);
  return fmt::format("{:.4g} um", 1e6 * metres);
}

std::string count_text(double count) {
  std::string digits = fmt::format("{:.0f}", count);
  const std::size_t first = digits.starts_with('-') ? 1 : 0;
  for (std::size_t i = digits.size(); i > first + 3;) {
    i -= 3;
    digits.insert(i, 1, ',');
  }
  return digits;
}

}  // namespace breccia
