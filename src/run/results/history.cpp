#include "run/results/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <limits>

#include "core/probe.hpp"
#include "core/quantity.hpp"
#include "io/whole_file.hpp"

namespace breccia {
namespace {

/// The column's text, quoted if it holds a comma, a quote or a line end.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result;
  result.push_back('"');
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c == '\n' ? ' ' : c;
  }
  result.push_back('"');
  return result;
}

bool is_empty(const std::string& path) {
  std::error_code error;
  return std::filesystem::file_size(path, error) == 0;
}

constexpr int energies = 8;
constexpr std::size_t time_column = 1, first_probe = 3 + energies + 1;

/// Field k of a row of numbers, which no comma is in.
double number_in(std::string_view row, std::size_t k) {
  for (; k > 0; --k) row.remove_prefix(std::min(row.find(',') + 1, row.size()));
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(row.data(), row.data() + row.size(), value);
  return value;
}

}  // namespace

History::History(const std::string& path, const std::vector<ProbeConfig>& probes, bool in_plane,
                 bool stages)
    : file_(path) {
  if (!is_empty(path)) return;
  std::string names;
  for (const char* column : history_columns)
    names += names.empty() ? column : std::string(",") + column;
  std::string units = "-,s,s";
  const auto add_unit = [&](const std::string& unit) {
    units.append(",").append(in_plane ? per_metre(unit) : unit);
  };
  for (int k = 0; k < energies; ++k) add_unit("J");
  add_unit("-");
  for (const ProbeConfig& probe : probes) {
    names.append(",").append(quoted(probe.name));
    add_unit(quantity_named(probe.quantity).unit);
  }
  if (stages) {
    names += ",stage";
    units += ",name";
  }
  file_.append(names);
  file_.append(units);
}

void History::write(const Sample& sample) {
  const EnergyBalance& e = sample.energy;
  std::string row = fmt::format("{}", sample.step);
  for (const double number :
       {sample.time, sample.time_step, e.kinetic, e.elastic, e.fracture, e.plastic, e.friction,
        e.damping, e.contact, e.work, e.error_relative})
    row += fmt::format(",{:.17g}", number);
  for (const double number : sample.probes) row += fmt::format(",{:.17g}", number);
  if (!sample.stage.empty()) row.append(",").append(quoted(sample.stage));
  file_.append(row);
}

std::optional<double> History::probe_at(const std::string& path, std::size_t probe, double time) {
  const std::string text = read_whole_file(path);
  std::optional<double> before_time, before;
  std::size_t line = 0;
  for (std::size_t at = 0; at < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view row(text.data() + at, end - at);
    at = end + 1;
    if (line < 2 || row.empty()) continue;
    const double now = number_in(row, time_column), value = number_in(row, first_probe + probe);
    if (now == time) return value;
    if (now > time) {
      if (!before) return std::nullopt;
      return *before + (time - *before_time) / (now - *before_time) * (value - *before);
    }
    before_time = now;
    before = value;
  }
  return std::nullopt;
}

std::int64_t History::cut_to(const std::string& path, std::int64_t step) {
  int line_number = 0;
  std::int64_t last = -1;
  keep_lines(path, [&](std::string_view line) {
    if (++line_number <= 2) return true;
    std::int64_t row_step = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), row_step);
    const bool keeps = error == std::errc{} && *end == ',' && row_step <= step;
    if (keeps) last = row_step;
    return keeps;
  });
  return last;
}

}  // namespace breccia
