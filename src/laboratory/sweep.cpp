#include "laboratory/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "exec/error.hpp"
#include "io/case/suggestion.hpp"

namespace breccia::laboratory {
namespace {

constexpr std::size_t most_runs = 10'000;

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}
bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

/// Numbers of a text, and what stands before each and behind the last.
struct Numbers {
  std::vector<double> values;
  std::vector<std::string> between{""};
};
Numbers numbers_in(const std::string& text) {
  Numbers found;
  for (std::size_t at = 0; at < text.size();) {
    const bool in_word = at > 0 && (is_letter(text[at - 1]) || text[at - 1] == '_');
    double value = 0.0;
    const std::size_t sign = text[at] == '+' ? 1 : 0;
    const bool begins = is_digit(text[at]) || text[at] == '-' || text[at] == '+' || text[at] == '.';
    const auto [end, error] =
        std::from_chars(text.data() + at + sign, text.data() + text.size(), value);
    if (begins && !in_word && error == std::errc{}) {
      found.values.push_back(value);
      found.between.emplace_back();
      at = static_cast<std::size_t>(end - text.data());
    } else {
      found.between.back() += text[at++];
    }
  }
  return found;
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  return begin == std::string::npos ? ""
                                    : text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// Parts between commas outside of brackets and quotes.
std::vector<std::string> items_of(const std::string& text) {
  std::vector<std::string> items{""};
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',' && depth == 0) {
      items.emplace_back();
      continue;
    }
    items.back() += c;
  }
  for (std::string& item : items) item = trimmed(item);
  return items;
}

[[noreturn]] void refuse(const std::string& text, const std::string& problem) {
  throw InputError(fmt::format("--over {}: {}; nothing was run", text, problem));
}

/// The values of "A..B:N", or nothing if the text is no range.
std::vector<std::string> range_of(const std::string& text, const std::string& item) {
  const std::size_t dots = item.find(".."), colon = item.rfind(':');
  if (dots == std::string::npos) return {};
  if (colon == std::string::npos || colon < dots) {
    if (numbers_in(item.substr(0, dots)).values.empty()) return {};  // dots of a path
    refuse(text, "a range says how many values it has, as in KEY=A..B:5");
  }
  int count = 0;
  const std::string digits = trimmed(item.substr(colon + 1));
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
  if (error != std::errc{} || end != digits.data() + digits.size() || count < 2 ||
      count > static_cast<int>(most_runs))
    refuse(text, fmt::format("{} behind the colon is no count from 2 to {}", digits, most_runs));
  const Numbers from = numbers_in(trimmed(item.substr(0, dots)));
  const Numbers to = numbers_in(trimmed(item.substr(dots + 2, colon - dots - 2)));
  bool alike = from.values.size() == to.values.size() && !from.values.empty();
  for (std::size_t k = 0; alike && k < to.between.size(); ++k)
    alike = from.between[k].empty() || from.between[k] == to.between[k];
  if (!alike) refuse(text, "the two ends of a range differ in more than their numbers");
  std::vector<std::string> values;
  for (int n = 0; n < count; ++n) {
    const double share = static_cast<double>(n) / (count - 1);
    std::string value = to.between[0];
    for (std::size_t k = 0; k < to.values.size(); ++k)
      value += fmt::format("{:.12g}", (1.0 - share) * from.values[k] + share * to.values[k]) +
               to.between[k + 1];
    values.push_back(value);
  }
  return values;
}

std::string last_word(const std::string& key) {
  const std::size_t dot = key.rfind('.');
  return dot == std::string::npos ? key : key.substr(dot + 1);
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string cell(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '|' ? std::string("\\|") : std::string(1, c);
  return safe;
}

std::vector<std::string> default_measures(const std::vector<SweepRow>& rows) {
  std::vector<std::string> measures;
  for (const SweepRow& row : rows) {
    if (!row.result) continue;
    const RunResult& result = *row.result;
    for (const CheckedNumber& check : result.checks) measures.push_back(check.name);
    for (const char* path : {"fracture.broken_links", "fracture.broken_joints",
                             "fracture.fragments", "fracture.largest_fragment_fraction"})
      if (result.numbers.contains(path)) measures.emplace_back(path);
    for (const std::string& probe : result.probes)
      for (const char* which : {".peak", ".last"}) measures.push_back("probe." + probe + which);
    measures.emplace_back("energy.error_relative");
    break;
  }
  return measures;
}

/// A check may have no number.
bool has_check(const RunResult& result, const std::string& name) {
  return std::any_of(result.checks.begin(), result.checks.end(),
                     [&](const CheckedNumber& check) { return check.name == name; });
}

std::string state_of(const FinishedRun& run) {
  if (run.exit_code == 0) return "done";
  if (run.exit_code == 9) return "check failed";
  return run.exit_code > 128 ? "interrupted" : "failed";
}

/// Why a run has no result, and where all it said is.
std::string failure_of(const SweepRow& row) {
  const std::string& message = row.run.message;
  if (message.empty()) return "was not run";
  const std::string code =
      row.run.ended_mute() ? "" : fmt::format("exit code {}: ", row.run.exit_code);
  return fmt::format("{}{}; all it said: {}", code, cell(message), cell(log_beside(row.folder)));
}

}  // namespace

SweepAxis sweep_axis(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    refuse(text, "it is not of the form KEY=A,B,C or KEY=A..B:N");
  SweepAxis axis{trimmed(text.substr(0, equals)), {}};
  for (const std::string& item : items_of(text.substr(equals + 1))) {
    if (item.empty()) refuse(text, "a value is empty");
    const std::vector<std::string> range = range_of(text, item);
    if (range.empty()) axis.values.push_back(item);
    axis.values.insert(axis.values.end(), range.begin(), range.end());
  }
  const std::set<std::string> different(axis.values.begin(), axis.values.end());
  if (different.size() != axis.values.size()) refuse(text, "a value stands there twice");
  return axis;
}

std::vector<std::string> SweepPoint::overrides(const std::vector<SweepAxis>& axes) const {
  std::vector<std::string> result;
  for (std::size_t k = 0; k < axes.size(); ++k) result.push_back(axes[k].key + "=" + values[k]);
  result.push_back(fmt::format("seed={}", seed));
  return result;
}

std::string SweepPoint::name(const std::vector<SweepAxis>& axes) const {
  std::string text;
  for (std::size_t k = 0; k < axes.size(); ++k)
    text += last_word(axes[k].key) + "=" + values[k] + " ";
  return text + fmt::format("seed={}", seed);
}

std::vector<std::int64_t> sweep_seeds(std::vector<SweepAxis>& axes, std::int64_t first, int count) {
  std::vector<std::int64_t> seeds;
  for (std::size_t k = 0; k < axes.size(); ++k)
    for (std::size_t before = 0; before < k; ++before)
      if (axes[k].key == axes[before].key)
        refuse(axes[k].key, "the key is varied twice; one list may hold all values");
  const auto axis = std::find_if(axes.begin(), axes.end(),
                                 [](const SweepAxis& one) { return one.key == "seed"; });
  if (axis == axes.end()) {
    for (int k = 0; k < count; ++k) seeds.push_back(first + k);
    return seeds;
  }
  if (count > 1) refuse("seed", "--seeds gives seeds, too; one of both is enough");
  for (const std::string& value : axis->values) {
    const char* const end = value.data() + value.size();
    std::int64_t seed = 0;
    if (std::from_chars(value.data(), end, seed) != std::from_chars_result{end, std::errc{}})
      refuse("seed=" + value, "a seed is a whole number");
    seeds.push_back(seed);
  }
  axes.erase(axis);
  return seeds;
}

std::vector<SweepPoint> sweep_points(const std::vector<SweepAxis>& axes,
                                     const std::vector<std::int64_t>& seeds) {
  std::vector<SweepPoint> points{{}};
  for (const SweepAxis& axis : axes) {
    if (points.size() * axis.values.size() * seeds.size() > most_runs)
      throw InputError(fmt::format("these are more than {} runs; nothing was run", most_runs));
    std::vector<SweepPoint> longer;
    for (const SweepPoint& point : points)
      for (const std::string& value : axis.values) {
        longer.push_back(point);
        longer.back().values.push_back(value);
      }
    points = std::move(longer);
  }
  std::vector<SweepPoint> seeded;
  for (const SweepPoint& point : points)
    for (const std::int64_t seed : seeds) seeded.push_back({point.values, seed});
  return seeded;
}

std::string run_folder_name(const std::string& name, const std::string& digest) {
  std::string safe;
  for (const char c : name.substr(0, 80))
    safe += is_digit(c) || is_letter(c) || c == '=' || c == '.' || c == '-' ? c : '_';
  return safe + "-" + digest.substr(0, 8);
}

SweepTable::SweepTable(std::vector<SweepAxis> axes, std::vector<SweepRow> rows,
                       std::vector<std::string> measures)
    : axes_(std::move(axes)), rows_(std::move(rows)), measures_(std::move(measures)) {
  if (measures_.empty()) measures_ = default_measures(rows_);
}

std::string SweepTable::unknown_measure() const {
  const auto row = std::find_if(rows_.begin(), rows_.end(), [](const auto& r) { return r.result; });
  if (row == rows_.end()) return "";
  std::set<std::string> known;
  for (const auto& [path, number] : row->result->numbers) known.insert(path);
  for (const std::string& measure : default_measures(rows_)) known.insert(measure);
  for (const std::string& measure : measures_)
    if (std::all_of(rows_.begin(), rows_.end(), [&](const SweepRow& r) {
          return !r.result || (!r.result->number(measure) && !has_check(*r.result, measure));
        }))
      return fmt::format("--measure {}: no run has it{}", measure, suggestion(measure, known));
  return "";
}

double SweepTable::value(const SweepRow& row, const std::string& measure) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  return row.result ? row.result->number(measure).value_or(none) : none;
}

std::vector<SweepTable::Group> SweepTable::groups() const {
  std::vector<Group> groups;
  for (const SweepRow& row : rows_)
    if (groups.empty() || groups.back().values != row.point.values)
      groups.push_back({row.point.values, {}});
  for (Group& group : groups)
    for (const std::string& measure : measures_) {
      std::vector<double> values;
      for (const SweepRow& row : rows_)
        if (row.point.values == group.values) values.push_back(value(row, measure));
      group.spreads.push_back(spread_of(values));
    }
  return groups;
}

std::string SweepTable::csv() const {
  std::string text;
  for (const SweepAxis& axis : axes_) text += csv_field(axis.key) + ",";
  text += "seed,status,exit_code";
  for (const std::string& measure : measures_) text += "," + csv_field(measure);
  text += ",folder,message\n";
  for (const SweepRow& row : rows_) {
    for (const std::string& v : row.point.values) text += csv_field(v) + ",";
    text += fmt::format("{},{},{}", row.point.seed, state_of(row.run), row.run.exit_code);
    for (const std::string& measure : measures_) {
      const double number = value(row, measure);
      text += std::isnan(number) ? std::string(",") : fmt::format(",{}", number);
    }
    text += "," + csv_field(row.folder) + "," + csv_field(row.run.message) + "\n";
  }
  return text;
}

std::string SweepTable::markdown(const std::string& title) const {
  std::string head = "|", rule = "|";
  for (const SweepAxis& axis : axes_) {
    head += " " + cell(axis.key) + " |";
    rule += "---|";
  }
  std::string measured, measured_rule;
  for (const std::string& measure : measures_) {
    measured += " " + cell(measure) + " |";
    measured_rule += "---|";
  }
  std::string text = "# " + title + "\n\n";
  if (std::none_of(rows_.begin(), rows_.end(), [](const auto& row) { return row.result; })) {
    text += "No run has a result.\n";
  } else {
    text += "Mean, +- the deviation of the sample, and how many runs.\n\n";
    text += (axes_.empty() ? "|" : head) + measured + "\n" + (axes_.empty() ? "|" : rule) +
            measured_rule + "\n";
    for (const Group& group : groups()) {
      text += "|";
      for (const std::string& v : group.values) text += " " + cell(v) + " |";
      for (const Spread& spread : group.spreads) text += " " + spread_text(spread) + " |";
      text += "\n";
    }
  }
  text += "\n## Every run\n\n" + head + " seed | status |" + measured + "\n" + rule + "---|---|" +
          measured_rule + "\n";
  std::string failures;
  for (const SweepRow& row : rows_) {
    text += "|";
    for (const std::string& v : row.point.values) text += " " + cell(v) + " |";
    text += fmt::format(" {} | {} |", row.point.seed, state_of(row.run));
    for (const std::string& measure : measures_) {
      const double number = value(row, measure);
      text += " " + (std::isnan(number) ? std::string("-") : short_number(number)) + " |";
    }
    text += "\n";
    if (!row.run.complete())
      failures += fmt::format("- {}: {}\n", cell(row.point.name(axes_)), failure_of(row));
  }
  if (!failures.empty()) text += "\n## Runs without a result\n\n" + failures;
  return text;
}

LinePlot SweepTable::plot_over_seeds(const std::string& measure) const {
  LinePlot plot{measure, "seed", "value", {}, {}, {}};
  PlotSeries series{"", {}, {}, {}, false, true};
  std::vector<double> values;
  for (const SweepRow& row : rows_) {
    series.x.push_back(static_cast<double>(row.point.seed));
    series.y.push_back(value(row, measure));
  }
  const Spread spread = spread_of(series.y);
  if (spread.n > 0) plot.levels = {{"mean " + short_number(spread.mean), spread.mean}};
  plot.series.push_back(series);
  return plot;
}

LinePlot SweepTable::plot_over_axis(std::size_t measure, const std::vector<Group>& groups) const {
  LinePlot plot{measures_[measure], axes_.front().key, "mean, deviation", {}, {}, {}};
  const std::vector<std::string>& values = axes_.front().values;
  // A number if that is all that differs: the x of a value; else its place in the list.
  std::vector<double> places;
  std::set<double> different;
  for (const std::string& text : values) {
    const Numbers numbers = numbers_in(text);
    places.push_back(numbers.values.size() == 1 ? numbers.values[0] : 0.0);
    different.insert(places.back());
  }
  if (different.size() != values.size()) {
    for (std::size_t k = 0; k < values.size(); ++k) places[k] = static_cast<double>(k);
    plot.x_words = values;
  }
  std::map<std::vector<std::string>, PlotSeries> lines;
  for (const Group& group : groups) {
    const std::vector<std::string> others(group.values.begin() + 1, group.values.end());
    PlotSeries& line = lines[others];
    line.name = fmt::format("{}", fmt::join(others, ", "));
    line.marks = true;
    const auto at = std::find(values.begin(), values.end(), group.values.front());
    const Spread& spread = group.spreads[measure];
    line.x.push_back(places[static_cast<std::size_t>(at - values.begin())]);
    line.y.push_back(spread.n > 0 ? spread.mean : std::numeric_limits<double>::quiet_NaN());
    line.error.push_back(spread.deviation);
  }
  for (auto& [others, line] : lines) plot.series.push_back(line);
  return plot;
}

std::vector<LinePlot> SweepTable::plots() const {
  const std::vector<Group> all = groups();
  std::vector<LinePlot> plots;
  for (std::size_t m = 0; m < measures_.size(); ++m)
    plots.push_back(axes_.empty() ? plot_over_seeds(measures_[m]) : plot_over_axis(m, all));
  return plots;
}

}  // namespace breccia::laboratory
