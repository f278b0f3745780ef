#include "app/board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/probe.hpp"
#include "io/harmless.hpp"
#include "io/round_numbers.hpp"

namespace breccia::app {
namespace {

constexpr std::array bars{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
constexpr std::array plain_bars{"_", ".", ",", "-", "=", "+", "*", "#"};
constexpr std::size_t name_width = 18, bars_width = 40;
constexpr std::size_t columns_before_probes = std::size(history_columns);

/// A number with three digits and its unit with a prefix.
std::string with_unit(double value, const std::string& unit) {
  if (unit.empty() || unit == "-") return fmt::format("{:.3g}", value);
  const ScaledUnit scaled = scaled_unit(unit, std::abs(value));
  return fmt::format("{:.3g}{}{}", value * scaled.factor, scaled.unit.empty() ? "" : " ",
                     scaled.unit);
}

double last_of(const report::NumberTable& history, const char* name) {
  const report::Column* const column = history.column(name);
  return column == nullptr || column->values.empty() ? 0.0 : column->values.back();
}

std::string curve_line(const report::Column& column, bool plain) {
  std::string name = harmless(column.name);
  if (name.size() > name_width) name.resize(name_width);
  const std::string value =
      column.values.empty() ? "" : with_unit(column.values.back(), column.unit);
  const std::string bars_text = sparkline(column.values, bars_width, plain);
  return fmt::format("  {:<{}}  {}  {}\n", name, name_width, bars_text, value.substr(0, 16));
}

}  // namespace

std::string sparkline(const std::vector<double>& values, std::size_t width, bool plain) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  std::vector<double> means;
  const std::size_t count = std::min(width, values.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i * values.size() / count, end = (i + 1) * values.size() / count;
    double sum = 0.0;
    for (std::size_t k = begin; k < end; ++k) sum += values[k];
    means.push_back(sum / static_cast<double>(end - begin));
    if (!std::isfinite(means.back())) continue;
    low = std::min(low, means.back());
    high = std::max(high, means.back());
  }
  std::string text;
  for (const double mean : means) {
    const double share = high > low ? (mean - low) / (high - low) : 0.0;
    if (std::isfinite(mean))
      text += (plain ? plain_bars : bars)[static_cast<std::size_t>(std::min(7.0, 8.0 * share))];
    else
      text += ' ';
  }
  return text.append(width - count, ' ');
}

std::string board(const Watched& run, bool plain) {
  std::string text = fmt::format("{}  {}  {}  {}\n", harmless(run.folder), harmless(run.case_name),
                                 harmless(run.method), harmless(run.status));
  const report::NumberTable& history = run.history;
  if (history.rows() == 0) return text + "  no row of its history yet\n";
  const double time = last_of(history, "time");
  text += fmt::format("  time {}", time_text(time));
  if (run.end_time > 0.0)
    text += fmt::format(" of {} ({:.0f} %)", time_text(run.end_time),
                        std::min(100.0, 100.0 * time / run.end_time));
  text += fmt::format("   step {}   dt {}", count_text(last_of(history, "step")),
                      time_text(last_of(history, "dt")));
  text += fmt::format("\n  energy error {:.2e}", last_of(history, "error_relative"));
  if (run.broken) text += fmt::format("   broken {}", count_text(*run.broken));
  text += '\n';
  for (const char* name : {"kinetic", "elastic", "fracture", "error_relative"})
    if (const report::Column* const column = history.column(name))
      text += curve_line(*column, plain);
  for (std::size_t i = columns_before_probes; i < history.columns.size(); ++i)
    text += curve_line(history.columns[i], plain);
  return text;
}

}  // namespace breccia::app
