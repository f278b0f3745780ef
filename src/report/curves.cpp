#include "report/curves.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "core/probe_curve.hpp"
#include "io/picture/line_plot.hpp"
#include "io/round_numbers.hpp"

namespace breccia::report {
namespace {

using Columns = std::vector<const Column*>;

double largest_of(const Columns& columns) {
  double largest = 0.0;
  for (const Column* column : columns)
    for (const double value : column->values)
      if (std::isfinite(value)) largest = std::max(largest, std::fabs(value));
  return largest;
}

std::vector<double> scaled(const std::vector<double>& values, double factor) {
  std::vector<double> all = values;
  for (double& value : all) value *= factor;
  return all;
}

std::string label_of(const std::string& name, const std::string& unit) {
  return unit.empty() || unit == "-" ? name : name + " [" + unit + "]";
}

LinePlot plot_of(const Column& x, const Columns& columns) {
  const ScaledUnit along = scaled_unit(x.unit, largest_of({&x})),
                   up = scaled_unit(columns.front()->unit, largest_of(columns));
  LinePlot plot;
  plot.x_label = label_of(x.name, along.unit);
  plot.y_label = label_of(columns.size() == 1 ? columns.front()->name : "", up.unit);
  for (const Column* column : columns)
    plot.series.push_back({columns.size() == 1 ? "" : column->name,
                           scaled(x.values, along.factor),
                           scaled(column->values, up.factor),
                           {}});
  return plot;
}

/// A column as a curve takes it: its name and values with their sign.
std::optional<Column> taken(const NumberTable& table, const ProbeCurve::Axis& axis) {
  const Column* const column = table.column(axis.probe);
  if (column == nullptr) return std::nullopt;
  Column turned = *column;
  if (axis.sign < 0.0) {
    turned.name = "-" + turned.name;
    turned.values = scaled(turned.values, axis.sign);
  }
  return turned;
}

bool is_strain(const Column& column) {
  std::string name = column.name;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return column.unit == "-" && name.find("strain") != std::string::npos;
}

}  // namespace

std::string curves_of(const Record& record) {
  const Column* const time = record.history.column("time");
  std::set<std::string> probes;
  for (const auto& [path, value] : record.numbers)
    if (path.starts_with("probe.") && path.ends_with(".last"))
      probes.insert(path.substr(6, path.size() - 11));
  std::vector<std::pair<std::string, Columns>> by_unit;
  const Column* strain = nullptr;
  for (const Column& column : record.history.columns) {
    if (!probes.contains(column.name)) continue;
    if (strain == nullptr && is_strain(column)) strain = &column;
    const auto known = std::find_if(by_unit.begin(), by_unit.end(),
                                    [&](const auto& of) { return of.first == column.unit; });
    if (known == by_unit.end())
      by_unit.push_back({column.unit, {&column}});
    else
      known->second.push_back(&column);
  }
  if (time == nullptr || by_unit.empty()) return "";
  std::vector<LinePlot> plots;
  for (const std::string& text : record.scene.curves)
    if (const std::optional<ProbeCurve> curve = ProbeCurve::parsed(text)) {
      const std::optional<Column> x = taken(record.history, curve->x),
                                  y = taken(record.history, curve->y);
      if (x && y) plots.push_back(plot_of(*x, {&*y}));
    }
  for (const auto& [unit, columns] : by_unit)
    if (strain != nullptr && unit == "Pa") plots.push_back(plot_of(*strain, columns));
  for (const auto& [unit, columns] : by_unit) plots.push_back(plot_of(*time, columns));
  plots.front().title = record.scene.title;
  return svg_of(plots, plots.size() > 1 ? 2 : 1);
}

}  // namespace breccia::report
