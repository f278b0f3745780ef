#include "run/results/history.hpp"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "core/quantity.hpp"

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

}  // namespace

History::History(const std::string& path, const std::vector<ProbeConfig>& probes, bool in_plane,
                 bool stages)
    : file_(path) {
  if (!is_empty(path)) return;
  std::string names =
      "step,time,dt,kinetic,elastic,fracture,plastic,friction,damping,contact,work,error_relative";
  std::string units = "-,s,s";
  const auto add_unit = [&](const std::string& unit) {
    units.append(",").append(in_plane ? per_metre(unit) : unit);
  };
  constexpr int energies = 8;
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

void History::cut_to(const std::string& path, std::int64_t step) {
  int line_number = 0;
  keep_lines(path, [&](std::string_view line) {
    if (++line_number <= 2) return true;
    std::int64_t row_step = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), row_step);
    return error == std::errc{} && *end == ',' && row_step <= step;
  });
}

}  // namespace breccia
