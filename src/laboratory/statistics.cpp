#include "laboratory/statistics.hpp"

#include <fmt/format.h>

#include <cmath>

namespace breccia::laboratory {

Spread spread_of(const std::vector<double>& values) {
  Spread spread;
  for (const double value : values)
    if (std::isfinite(value)) {
      spread.mean += value;
      ++spread.n;
    }
  if (spread.n == 0) return spread;
  spread.mean /= spread.n;
  double squares = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) squares += (value - spread.mean) * (value - spread.mean);
  if (spread.n > 1) spread.deviation = std::sqrt(squares / (spread.n - 1));
  constexpr double rounding = 1e-13;  // of numbers that were equal before they were divided
  if (spread.deviation < rounding * std::abs(spread.mean)) spread.deviation = 0.0;
  return spread;
}

std::string short_number(double value) {
  return fmt::format("{:.4g}", value);
}

std::string spread_text(const Spread& spread, double factor) {
  if (spread.n == 0) return "-";
  if (spread.n == 1) return short_number(factor * spread.mean) + " (1)";
  return fmt::format("{} +- {:.2g} ({})", short_number(factor * spread.mean),
                     std::abs(factor) * spread.deviation, spread.n);
}

}  // namespace breccia::laboratory
