#include "io/picture/color_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace breccia {

Spread spread_of(const std::vector<float>& values) {
  std::vector<float> sorted;
  for (const float value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  if (sorted.empty()) return {{0.0, 0.0}, {0.0, 0.0}};
  std::sort(sorted.begin(), sorted.end());
  const ValueRange whole{sorted.front(), sorted.back()};
  if (sorted.size() < 1000) return {whole, whole};
  const std::size_t cut = sorted.size() / 500;  // two in a thousand at either end
  const ValueRange bulk{sorted[cut], sorted[sorted.size() - 1 - cut]};
  const double margin = 0.5 * (bulk.high - bulk.low);
  if (!(margin > 0.0)) return {whole, whole};
  return {{whole.low < bulk.low - margin ? bulk.low : whole.low,
           whole.high > bulk.high + margin ? bulk.high : whole.high},
          whole};
}

Legend::Bar bar_of(const std::string& name, const std::string& unit, const Spread& spread,
                   const std::optional<ValueRange>& wanted) {
  const bool ends_on_damage = name.size() >= 6 && name.substr(name.size() - 6) == "damage";
  if (ends_on_damage && spread.whole.low >= 0.0 && spread.whole.high <= 1.0) {
    return {ColorMap::damage, wanted.value_or(ValueRange{0.0, 1.0}), {}, ""};
  }
  if (wanted) {
    const bool centred = wanted->low < 0.0 && std::fabs(wanted->low + wanted->high) <
                                                  1e-6 * (wanted->high - wanted->low);
    return {centred ? ColorMap::diverging : ColorMap::viridis, *wanted, {}, ""};
  }
  Legend::Bar bar{ColorMap::viridis, spread.shown, {}, ""};
  const double smaller = std::min(-bar.range.low, bar.range.high);
  const double largest = std::max(std::fabs(bar.range.low), std::fabs(bar.range.high));
  if (smaller > 0.02 * largest) {
    bar.map = ColorMap::diverging;
    bar.range = {-largest, largest};
  } else if (bar.range.low > 0.0 && bar.range.low < 0.5 * bar.range.high) {
    bar.range.low = 0.0;
  }
  bar.range = rounded_outwards(beyond_rounding(bar.range, unit));
  return bar;
}

void finish_legend(Legend& legend, const std::string& name, const std::string& unit,
                   const ValueRange& whole) {
  Legend::Bar& bar = *legend.bar;
  const double largest = std::max(std::fabs(bar.range.low), std::fabs(bar.range.high));
  const ScaledUnit scaled = scaled_unit(unit, largest);
  legend.title = scaled.unit.empty() ? name : fmt::format("{} [{}]", name, scaled.unit);
  bar.ticks = ticks_of(bar.range, scaled.factor);
  const double rounding = 1e-6 * (bar.range.high - bar.range.low);
  if (whole.high > bar.range.high + rounding)
    bar.note = fmt::format("max {:.3g}", scaled.factor * whole.high);
  if (whole.low < bar.range.low - rounding)
    bar.note +=
        fmt::format("{}min {:.3g}", bar.note.empty() ? "" : ", ", scaled.factor * whole.low);
}

std::vector<Color> mapped_colors(const Legend::Bar& bar, const std::vector<float>& values) {
  const double width = bar.range.high - bar.range.low;
  const auto low = static_cast<float>(bar.range.low);
  const auto factor = static_cast<float>(width > 0.0 ? 1.0 / width : 1.0);
  std::vector<Color> colors(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    colors[i] = map_color(bar.map, factor * (values[i] - low));
  }
  return colors;
}

std::vector<Color> log_colors(Legend& legend, const std::string& name, const std::string& unit,
                              std::vector<float>& values, const std::optional<ValueRange>& wanted,
                              const std::string& map) {
  constexpr double decades = 1e-4;
  double largest = 0.0;
  for (float& value : values) {
    value = std::fabs(value);
    if (std::isfinite(value)) largest = std::max<double>(largest, value);
  }
  if (wanted) largest = std::max(std::fabs(wanted->low), std::fabs(wanted->high));
  if (!(largest > 0.0)) largest = 1.0;
  const double least = wanted && wanted->low > 0.0 ? wanted->low : decades * largest;
  const ScaledUnit scaled = scaled_unit(unit, largest);
  Legend::Bar bar{map.empty() ? ColorMap::viridis : map_named(map),
                  {std::log10(least), std::log10(largest)},
                  {},
                  ""};
  for (int power = static_cast<int>(std::ceil(bar.range.low + std::log10(scaled.factor) - 1e-9));
       power <= bar.range.high + std::log10(scaled.factor) + 1e-9; ++power)
    bar.ticks.push_back(
        {power - std::log10(scaled.factor), fmt::format("{:g}", std::pow(10.0, power))});
  legend.title = scaled.unit.empty() ? name : fmt::format("{} [{}]", name, scaled.unit);
  legend.bar = bar;
  for (float& value : values)
    value = static_cast<float>(std::log10(std::max<double>(value, least)));
  return mapped_colors(bar, values);
}

}  // namespace breccia
