#include "app/run_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

#include "app/option_kinds.hpp"
#include "domain/mpi_ranks.hpp"
#include "domain/together.hpp"
#include "io/case/units.hpp"

namespace breccia::app {
namespace {

/// The problem of a text that must be a number not below zero, empty if there is none.
template <class Number>
std::string problem_of(const std::string& text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool good = error == std::errc{} && end == text.data() + text.size() && number >= 0;
  return good ? ""
              : text + (std::is_integral_v<Number> ? " is not a count"
                                                   : " is no time such as 0.002 (s) or 2ms");
}

/// "2ms", "2 ms": 0.002; any other text as it is.
std::string in_seconds(const std::string& text) {
  std::string problem;
  const double seconds = parse_quantity(text, "s", problem);
  return problem.empty() ? fmt::format("{}", seconds) : text;
}

}  // namespace

void add_run_options(CLI::App& command, RunOptions& options) {
  command
      .add_option(
          "--device", options.device,
          "where to compute: cpu, cuda or cuda:N; +tiles or +launches behind it: how steps of the "
          "DEM are taken, which the model's size decides otherwise")
      ->type_name("NAME")
      ->capture_default_str();
  command
      .add_option("--threads", options.threads,
                  "host threads of each rank; default: its share of the machine")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  command.add_option("--steps", options.steps, "end after N steps since the start of the case")
      ->type_name("N")
      ->check(problem_of<std::int64_t>);
  command
      .add_option("--until", options.until,
                  "end at this simulated time, 0.002 or 2ms, instead of time.end")
      ->type_name("TIME")
      ->transform([](const std::string& text) { return in_seconds(text); })
      ->check(problem_of<double>);
  command
      .add_option("--stage", options.stage,
                  "end with this stage of the case; resume goes on with the next one")
      ->type_name("NAME");
  command
      .add_option(
          "--max-wall", options.max_wall,
          "save and end (exit code 10) before so much wall-clock time has passed: 3h50m, 90m, "
          "00:45:00, or a number of seconds; exit code 2 where the model is not built by then")
      ->type_name("TIME")
      ->check([](const std::string& text) {
        return wall_time(text) ? "" : text + " is no time such as 3h50m, 90m, 45 or 00:45:00";
      });
  add_repeated(&command, "--set", options.overrides,
               "override a key of the case; may be given repeatedly", "KEY=VALUE");
  command.add_flag("--allow-scripts", options.allow_scripts, allow_scripts_help);
  CLI::Option* const quiet =
      command.add_flag("-q,--quiet", options.quiet, "say nothing but errors");
  command.add_flag("-v,--verbose", options.verbose, "tell of each frame and checkpoint")
      ->excludes(quiet);
  command.add_flag("--no-progress", options.no_progress, "no progress bar or lines");
}

RunPlan plan_of(const Case& read, const RunOptions& options, const Exec& exec,
                Communicator* ranks) {
  RunPlan plan = plan_of(read);
  plan.limits = {options.until, options.steps, wall_time(options.max_wall), options.stage};
  plan.ends_anew = std::any_of(options.overrides.begin(), options.overrides.end(),
                               [](const auto& set) { return set.starts_with("time.end="); });
  plan.machine = {processor_name(), options.device, exec.threads,
                  ranks == nullptr ? 1 : ranks->size()};
  plan.timers = exec.timers;
  plan.ranks = ranks;
  const bool quiet = options.quiet || !leads(ranks);
  plan.speech = quiet ? Speech::quiet : options.verbose ? Speech::verbose : Speech::normal;
  // mpirun gives its ranks a terminal of their own, wherever it sends what they say.
  const Progress::Form form = ranks == nullptr ? Progress::form_for(stdout) : Progress::Form::lines;
  plan.progress = quiet || options.no_progress ? Progress::Form::none : form;
  return plan;
}

}  // namespace breccia::app
