// breccia sweep CASE: a case over values of its keys and over seeds, side by side.

#include "laboratory/sweep.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "app/option_kinds.hpp"
#include "app/side_by_side_options.hpp"
#include "exec/error.hpp"
#include "io/harmless.hpp"
#include "io/whole_file.hpp"
#include "run/case.hpp"
#include "run/machine/memory_plan.hpp"
#include "run/method/shown.hpp"
#include "run/results/result_folder.hpp"

namespace breccia::app {
namespace {

namespace lab = laboratory;

/// A case at a point of the sweep. Its problems name the option that a value came from.
Case case_at(const std::string& path, const std::vector<std::string>& overrides,
             const std::vector<lab::SweepAxis>& axes) {
  try {
    return load_case(path, overrides);
  } catch (const InputError& error) {
    std::string text = error.what();
    for (const lab::SweepAxis& axis : axes)
      for (std::size_t end = axis.key.find('.');; end = axis.key.find('.', end + 1)) {
        const std::string set = "--set " + axis.key.substr(0, end);
        for (std::size_t at = text.find(set); at != std::string::npos; at = text.find(set, at + 1))
          text.replace(at, 5, "--over");
        if (end == std::string::npos) break;
      }
    throw InputError(text);
  }
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at))
    text.replace(at, from.size(), to), at += to.size();
}

/// Names of numbers that no run will have are refused before any runs: they are looked at as those
/// of checks are.
void refuse_measures(const Case& base, const std::vector<std::string>& measures) {
  std::visit(
      [&](auto config) {
        std::vector<CheckConfig> asked;
        for (const std::string& measure : measures) {
          const auto is_it = [&](const CheckConfig& check) { return check.name == measure; };
          if (std::any_of(config.checks.begin(), config.checks.end(), is_it)) continue;
          CheckConfig& check = asked.emplace_back();
          check.name = check.value = measure;
          if (measure.starts_with("probe.") && measure.ends_with(".peak"))
            check.value = measure.substr(0, measure.size() - 4) + "max";
        }
        config.checks = asked;
        try {
          check_shown(config);
        } catch (const InputError& error) {
          std::string text = error.what();
          for (const CheckConfig& check : asked)
            replace_all(text, fmt::format("check.{}.value = {:?}", check.name, check.value),
                        "--measure " + check.name);
          replace_all(text, "in the case", "with what is to be measured");
          replace_all(text, ".max or .at", ".max or .peak");
          throw InputError(text);
        }
      },
      base.config);
}

struct SweepCommand {
  std::string path, folder;
  std::vector<std::string> over, measures, overrides;
  int seeds = 1;
  SideBySideOptions options;

  int execute() const {
    const Case base = load_case(path, overrides);
    refuse_measures(base, measures);
    if (!options.allow_scripts) refuse_scripts(base);
    std::vector<lab::SweepAxis> axes;
    for (const std::string& text : over) axes.push_back(lab::sweep_axis(text));
    const std::vector<std::int64_t> all_seeds = lab::sweep_seeds(axes, base.common().seed, seeds);
    const std::string out = folder.empty() ? "out/" + base.name + "_sweep" : folder;
    std::vector<lab::SweepRow> rows;
    std::vector<lab::PlannedRun> runs;
    std::vector<std::string> notes;
    double bytes = 0.0;
    for (const lab::SweepPoint& point : lab::sweep_points(axes, all_seeds)) {
      lab::PlannedRun run;
      run.name = point.name(axes);
      run.case_path = path;
      run.overrides = overrides;
      for (const std::string& text : point.overrides(axes)) run.overrides.push_back(text);
      const Case read = case_at(path, run.overrides, axes);
      run.digest = read.digest;
      for (const std::string& note : read.notes)
        if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
      run.folder = out + "/runs/" + lab::run_folder_name(run.name, run.digest);
      bytes = std::max(bytes, run_bytes(read));
      rows.push_back({point, run.folder, {}, {}});
      runs.push_back(run);
    }
    const lab::Workers workers = options.workers(runs.size(), bytes);
    make_folder(out);
    tell_notes(notes);
    fmt::print("{}: {} run{}, {} at a time\n", harmless(base.name), runs.size(),
               runs.size() == 1 ? "" : "s", workers.jobs);
    const auto results = lab::run_side_by_side(runs, workers, tell_of(runs));
    int exit_code = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      rows[k].run = results[k];
      if (results[k].complete()) rows[k].result = lab::read_result(rows[k].folder);
      if (exit_code == 0 || exit_code == 9)
        exit_code = results[k].exit_code != 0 ? std::abs(results[k].exit_code) : exit_code;
    }
    const lab::SweepTable table(axes, rows, measures);
    write(table, out, base.name);
    if (const std::string problem = table.unknown_measure(); !problem.empty())
      throw InputError(problem + "; the runs are kept");
    return exit_code;
  }

  static void write(const lab::SweepTable& table, const std::string& out, const std::string& name) {
    replace_file(out + "/sweep.csv", table.csv());
    replace_file(out + "/sweep.md", table.markdown("Sweep of " + name));
    replace_file(out + "/sweep.svg", svg_of(table.plots(), 2));
    for (const lab::SweepTable::Group& group : table.groups()) {
      if (!group.values.empty())
        fmt::print("{}\n", harmless(fmt::format("{}", fmt::join(group.values, ", "))));
      for (std::size_t m = 0; m < table.measures().size(); ++m)
        fmt::print("  {:<44} {}\n", harmless(table.measures()[m].substr(0, 44)),
                   lab::spread_text(group.spreads[m]));
    }
    fmt::print("table {0}/sweep.csv, {0}/sweep.md  plot {0}/sweep.svg\n", harmless(out));
  }
};

}  // namespace

void add_sweep(CLI::App& program, int& exit_code) {
  const auto sweep = std::make_shared<SweepCommand>();
  CLI::App* const command =
      program.add_subcommand("sweep", "run a case over values of keys and seeds, side by side");
  command->add_option("CASE", sweep->path, "a case file, or a folder with case.toml")->required();
  add_repeated(command, "--over", sweep->over, "values of a key; may be repeated", "KEY=VALUES");
  add_count(command, "--seeds", sweep->seeds, "seeds for each value; default: 1");
  add_repeated(command, "--measure", sweep->measures, "a number to compare; may be repeated",
               "PATH");
  add_repeated(command, "--set", sweep->overrides, "override a key in all runs", "KEY=VALUE");
  command->add_option("-o,--out", sweep->folder, "default: out/<case name>_sweep")
      ->type_name("DIR");
  add_side_by_side_options(*command, sweep->options);
  command->footer(
      "Values are a list, as in --over seed=1,2,5, or N values at even distances, as\n"
      "in --over 'body.rock.velocity=[0, 0, -10]..[0, 0, -40]:4'. Several --over give\n"
      "every combination; --seeds takes seeds from that of the case on.\n"
      "\n"
      "PATH is a number of summary.json such as fracture.fragments, the name of a\n"
      "check, or probe.NAME.last, .min, .max or .peak. Without any: checks, what broke\n"
      "and probes.\n"
      "\n"
      "Each run has a folder below DIR/runs. Called again, the command keeps finished\n"
      "runs of the same completed case and goes on with interrupted ones. DIR/sweep.csv\n"
      "has a line for each run, sweep.md means and deviations, sweep.svg the plots.\n"
      "A run that fails is in the tables, and the exit code is that of the first one.");
  command->callback([sweep, &exit_code] { exit_code = sweep->execute(); });
}

}  // namespace breccia::app
