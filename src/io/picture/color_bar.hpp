#pragma once
// The bar of colours of a field: its range, its ticks, and the colour of a value.

#include <optional>
#include <string>
#include <vector>

#include "io/picture/field_colors.hpp"

namespace breccia {

/// The range to show: all values, or where a few lie far out, the bulk of them.
struct Spread {
  ValueRange shown, whole;
};
Spread spread_of(const std::vector<float>& values);

Legend::Bar bar_of(const std::string& name, const std::string& unit, const Spread& spread,
                   const std::optional<ValueRange>& wanted);

/// Title and ticks of a legend with its bar, and what the bar leaves out.
void finish_legend(Legend& legend, const std::string& name, const std::string& unit,
                   const ValueRange& whole);

std::vector<Color> mapped_colors(const Legend::Bar& bar, const std::vector<float>& values);

/// By the logarithm of sizes: values, the bar's range and its ticks are logarithms then.
std::vector<Color> log_colors(Legend& legend, const std::string& name, const std::string& unit,
                              std::vector<float>& values, const std::optional<ValueRange>& wanted,
                              const std::string& map);

}  // namespace breccia
