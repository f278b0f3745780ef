// breccia compare RUN RUN: numbers of finished runs side by side.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/option_kinds.hpp"
#include "exec/error.hpp"
#include "io/case/key_pages.hpp"
#include "io/harmless.hpp"
#include "io/json.hpp"
#include "io/round_numbers.hpp"
#include "io/whole_file.hpp"
#include "laboratory/statistics.hpp"
#include "laboratory/sweep.hpp"
#include "report/table.hpp"
#include "run/results/result_folder.hpp"

namespace breccia::app {
namespace {

namespace lab = laboratory;

/// The results of a run, as a row of a table.
lab::SweepRow row_of(const std::string& folder) {
  if (!std::filesystem::exists(folder))
    throw IoError(folder + ": cannot be read: there is no such folder");
  lab::SweepRow row;
  row.folder = folder;
  row.result = lab::read_result(folder);
  if (!row.result)
    throw InputError(folder + ": this folder holds no run (there is no readable summary.json)");
  return row;
}

std::string hash_of(const std::string& folder) {
  const Json summary = read_json(read_whole_file(folder + "/summary.json"));
  const auto hash = summary.find("state_hash");
  return hash != summary.end() && hash->is_string() ? hash->get<std::string>() : "";
}

std::string number_text(const lab::SweepRow& row, const std::string& measure) {
  const auto number = row.result->number(measure);
  if (!number) return "-";
  const bool counts = *number == std::floor(*number) && *number >= 1e3 && *number < 1e9;
  return counts ? count_text(*number) : lab::short_number(*number);
}

/// The unit of a measure, from the header of history.csv; empty: none that it tells.
std::string unit_of(const report::NumberTable& history, const std::string& measure) {
  std::string column = measure;
  if (measure.starts_with("probe."))
    column = measure.substr(6, measure.rfind('.') - 6);
  else if (measure.starts_with("energy."))
    column = measure.substr(7);
  const report::Column* const found = history.column(column);
  return found == nullptr || found->unit == "-" ? "" : found->unit;
}

/// By how much the number of the second run is larger than that of the first one, also where both
/// are negative: 5 % where -1.05 is to -1.
std::string difference(const lab::SweepRow& first, const lab::SweepRow& second,
                       const std::string& measure) {
  const auto a = first.result->number(measure), b = second.result->number(measure);
  if (!a || !b) return "";
  if (*a == *b) return "alike";
  if (*a == 0.0) return "";
  return fmt::format("{:+.3g} %", 100.0 * (*b / *a - 1.0));
}

/// Names of checks are sentences: they fold.
constexpr std::size_t measure_width = 32;

void print_row(const std::string& name, const std::vector<std::string>& cells) {
  std::vector<std::string> lines = wrapped(harmless(name), measure_width);
  if (lines.empty()) lines.emplace_back();
  for (std::size_t k = 0; k + 1 < lines.size(); ++k) fmt::print("{}\n", lines[k]);
  std::string text = fmt::format("{:<{}}", lines.back(), measure_width);
  for (const std::string& cell : cells) text += fmt::format(" {:>11}", harmless(cell));
  text.erase(text.find_last_not_of(' ') + 1);
  fmt::print("{}\n", text);
}

struct CompareCommand {
  std::vector<std::string> folders, measures;

  void execute() const {
    std::vector<lab::SweepRow> rows;
    for (const std::string& folder : folders) rows.push_back(row_of(folder));
    const lab::SweepTable table({}, rows, measures);
    if (const std::string problem = table.unknown_measure(); !problem.empty())
      throw InputError(problem);
    const bool two = rows.size() == 2;
    char letter = 'a';
    std::vector<std::string> heads;
    for (const lab::SweepRow& row : rows) {
      const bool lost = row.result->status == "running" && !ResultFolder::is_locked(row.folder);
      fmt::print("{}  {}: {}{}\n", letter, harmless(row.folder),
                 lost ? "killed" : harmless(row.result->status),
                 row.result->complete() ? "" : ", not to the end of its case");
      heads.emplace_back(1, letter++);
    }
    if (two) heads.emplace_back("b over a");
    print_row("", heads);
    std::vector<std::string> shown{"steps", "time"};
    if (measures.empty())
      shown.insert(shown.end(), table.measures().begin(), table.measures().end());
    else
      shown = table.measures();
    const std::string table_of_first = folders[0] + "/history.csv";
    report::NumberTable history;
    if (std::filesystem::exists(table_of_first)) history = report::read_table(table_of_first);
    for (const std::string& measure : shown) {
      std::vector<std::string> cells;
      for (const lab::SweepRow& row : rows) cells.push_back(number_text(row, measure));
      if (two) cells.push_back(difference(rows[0], rows[1], measure));
      const std::string unit = unit_of(history, measure);
      print_row(unit.empty() ? measure : fmt::format("{} [{}]", measure, unit), cells);
    }
    const std::string first = hash_of(folders[0]);
    bool alike = !first.empty();
    for (const std::string& folder : folders) alike = alike && hash_of(folder) == first;
    fmt::print("states {}\n", alike ? "alike to the bit (" + first + ")" : "differ");
  }
};

}  // namespace

void add_compare(CLI::App& program) {
  const auto compare = std::make_shared<CompareCommand>();
  CLI::App* const command =
      program.add_subcommand("compare", "numbers of finished runs side by side");
  command->add_option("RUN", compare->folders, "result folders, two to four")
      ->required()
      ->expected(2, 4);
  add_repeated(command, "--measure", compare->measures, "a number to compare; may be repeated",
               "PATH");
  command->footer(
      "PATH is a number of summary.json such as fracture.fragments, the name of a\n"
      "check, or probe.NAME.last, .min, .max or .peak. Without any: checks, what broke\n"
      "and probes. `breccia report RUN RUN` shows pictures and curves beside each other.");
  command->callback([compare] { compare->execute(); });
}

}  // namespace breccia::app
