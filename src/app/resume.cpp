// breccia resume DIR: goes on from the newest good checkpoint of a result folder.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "app/findings.hpp"
#include "app/run_options.hpp"
#include "domain/together.hpp"
#include "exec/error.hpp"
#include "io/emphasis.hpp"
#include "io/harmless.hpp"
#include "run/machine/exec_choice.hpp"
#include "run/machine/set_up_limit.hpp"
#include "run/machine/signals.hpp"
#include "run/run.hpp"

namespace breccia::app {
namespace {

/// A run that goes on may end, save and draw differently; all else belongs to its states.
void refuse_fixed_keys(const std::vector<std::string>& overrides) {
  constexpr std::array changeable{"time.end=", "output.", "checkpoint.",
                                  "domain.",   "energy.", "title="};
  for (const std::string& text : overrides) {
    if (text.starts_with("output.format="))
      throw InputError("--set " + text +
                       ": the frames of a run have one format (breccia convert --frames writes "
                       "others); nothing was run");
    if (std::none_of(changeable.begin(), changeable.end(),
                     [&](const char* start) { return text.starts_with(start); }))
      throw InputError(
          fmt::format("--set {}: a run that goes on takes time.end, output.*, checkpoint.*, "
                      "domain.*, energy.* and title only; nothing was run",
                      text));
  }
}

/// A run of a prepared model goes on with that model: what built it may not be here.
void take_what_was_prepared(Case& read, const CheckpointReader& checkpoint,
                            const std::function<void(const std::string&)>& warn) {
  if (!checkpoint.has("run.prepared")) return;
  const std::string path = checkpoint.text("run.prepared");
  if (std::filesystem::exists(path))
    take_prepared(read, path);
  else
    warn(path + " is no longer there: its model is built anew");
}

struct ResumeCommand {
  RunOptions options;
  std::string path;

  int execute(Communicator* ranks) const {
    const auto begin = std::chrono::steady_clock::now();
    StopSignals signals;
    std::optional<SetUpLimit> limit;
    if (leads(ranks)) limit.emplace(wall_time(options.max_wall), options.max_wall);
    StageTimers timers;
    Exec exec;
    Case read;
    RunPlan plan;
    std::optional<ResultFolder> folder;          // of rank 0
    std::optional<CheckpointReader> checkpoint;  // every rank needs the folder of the case
    std::optional<RunState> former;
    collective_try(ranks, [&] {
      exec = exec_on(options.device, options.threads, ranks);
      exec.timers = &timers;
      refuse_fixed_keys(options.overrides);
      if (leads(ranks)) folder.emplace(ResultFolder::open(path));
      read = load_case(path + "/case.toml", options.overrides);
      const auto warn = [ranks](const std::string& warning) {
        if (leads(ranks))
          std::fputs(fmt::format("{} {}\n", emphasized(Emphasis::warning, "warning:", stderr),
                                 harmless(warning))
                         .c_str(),
                     stderr);
      };
      checkpoint.emplace(newest_good_checkpoint(path + "/checkpoints", warn));
      read.name = checkpoint->text("run.case_name");
      read.folder = checkpoint->text("run.case_folder");
      take_what_was_prepared(read, *checkpoint, warn);
      if (!options.allow_scripts) refuse_scripts(read);
      plan = plan_of(read, options, exec, ranks);
      plan.begin = begin;
      refuse_other_case(*checkpoint, plan);
      former.emplace(*checkpoint);
      if (!leads(ranks)) checkpoint.reset();
    });
    const std::unique_ptr<Method> method = make_method(read, exec, ranks, options.quiet);
    limit.reset();
    signals.answer_between_steps();
    timers.clear();
    method->load(checkpoint ? &*checkpoint : nullptr);
    Run run(*method, plan, folder ? &*folder : nullptr, &*former);
    return execute_and_tell(run, folder ? &*folder : nullptr, plan.config, options.quiet);
  }
};

}  // namespace

void add_resume(CLI::App& program, int& exit_code, Communicator* ranks) {
  const auto resume = std::make_shared<ResumeCommand>();
  CLI::App* const command =
      program.add_subcommand("resume", "go on from the newest good checkpoint of a run");
  command->add_option("DIR", resume->path, "the result folder of the run")->required();
  add_run_options(*command, resume->options);
  command->callback([resume, &exit_code, ranks] { exit_code = resume->execute(ranks); });
}

}  // namespace breccia::app
