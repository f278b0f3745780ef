// breccia run CASE: from the start of a case, or from one of its checkpoints.

#include "run/run.hpp"

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "app/findings.hpp"
#include "app/run_options.hpp"
#include "domain/together.hpp"
#include "run/machine/exec_choice.hpp"
#include "run/machine/set_up_limit.hpp"
#include "run/machine/signals.hpp"

namespace breccia::app {
namespace {

struct RunCommand {
  RunOptions options;
  std::string path, folder, restart;
  bool force = false;

  int execute(Communicator* ranks) const {
    const auto begin = std::chrono::steady_clock::now();
    StopSignals signals;
    std::optional<SetUpLimit> limit;
    if (leads(ranks)) limit.emplace(wall_time(options.max_wall), options.max_wall);
    StageTimers timers;
    const Existing existing = force ? Existing::replace : Existing::refuse;
    Exec exec;
    Case read;
    std::string out;
    collective_try(ranks, [&] {
      exec = exec_on(options.device, options.threads, ranks);
      exec.timers = &timers;
      read = load_case(path, options.overrides);
      if (!options.allow_scripts) refuse_scripts(read);
      out = folder.empty() ? "out/" + read.name : folder;
      if (leads(ranks)) ResultFolder::check_free(out, existing);
    });
    const std::unique_ptr<Method> method = make_method(read, exec, ranks, options.quiet);
    limit.reset();
    signals.answer_between_steps();
    RunPlan plan = plan_of(read, options, exec, ranks);
    plan.begin = begin;
    if (!restart.empty()) load(*method, plan);
    timers.clear();
    std::optional<ResultFolder> result;  // of rank 0
    on_first(ranks, [&] { result.emplace(ResultFolder::create(out, existing)); });
    Run run(*method, plan, result ? &*result : nullptr);
    return execute_and_tell(run, result ? &*result : nullptr, plan.config, options.quiet);
  }

  void load(Method& method, const RunPlan& plan) const {
    std::optional<CheckpointReader> checkpoint;
    on_first(plan.ranks, [&] {
      checkpoint.emplace(restart);
      refuse_other_case(*checkpoint, plan);
    });
    method.load(checkpoint ? &*checkpoint : nullptr);
  }
};

}  // namespace

void add_run(CLI::App& program, int& exit_code, Communicator* ranks) {
  const auto run = std::make_shared<RunCommand>();
  CLI::App* const command = program.add_subcommand("run", "run a case");
  command
      ->add_option("CASE", run->path,
                   "a case file, a folder that holds case.toml, or a prepared model")
      ->required();
  command->add_option("-o,--out", run->folder, "result folder; default: out/<case name>")
      ->type_name("DIR");
  command->add_option("--restart", run->restart, "begin from this checkpoint of the same case")
      ->type_name("FILE");
  command->add_flag("--force", run->force, "replace the run that the result folder holds");
  add_run_options(*command, run->options);
  command->callback([run, &exit_code, ranks] { exit_code = run->execute(ranks); });
}

}  // namespace breccia::app
