// breccia check CASE...: says every problem of the cases without running them.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "exec/error.hpp"
#include "io/harmless.hpp"
#include "io/round_numbers.hpp"
#include "run/case.hpp"
#include "run/machine/memory_plan.hpp"

namespace breccia::app {
namespace {

std::string counted(std::size_t count, const char* one, const char* several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

struct CheckCommand {
  std::vector<std::string> paths, overrides;
  bool model = false, allow_scripts = false;

  int execute() const {
    int exit_code = 0;
    for (const std::string& path : paths) {
      try {
        const Case read = load_case(path, overrides);
        check_files(read);
        if (model && !allow_scripts) refuse_scripts(read);
        std::visit(
            [&](const auto& config) {
              const MemoryPlan plan = memory_plan(config);
              refuse_without_memory(plan, plan.run_bytes, 1, path + ": the model");
              fmt::print("{}: good: {}, {}, {}, ends at {}", harmless(path), config.method,
                         counted(config.bodies.size(), "body", "bodies"),
                         counted(config.materials.size(), "material", "materials"),
                         time_text(config.time.end));
              if (plan.items > 0.0) fmt::print(", about {} of memory", memory_text(plan.run_bytes));
              if (const auto files = scripts_of(read); !files.empty())
                fmt::print(", needs --allow-scripts for {}",
                           harmless(fmt::format("{}", fmt::join(files, ", "))));
              fmt::print("\n");
            },
            read.config);
        if (model) tell_of_model(read);
      } catch (const Error& error) {
        std::fflush(stdout);
        std::fputs(fmt::format("error: {}\n", harmless(error.what())).c_str(), stderr);
        if (exit_code == 0) exit_code = error.exit_code();
      }
    }
    return exit_code;
  }

  static void tell_of_model(const Case& read) {
    const std::unique_ptr<Method> method = method_to_look_at(read);
    const std::string rule = method->step_rule();
    fmt::print("  step {:.3g} s{}\n", method->time_step(), rule.empty() ? "" : " ruled by " + rule);
    for (const Fact& fact : method->facts())
      if (fact.path.starts_with("model.rock.")) {
        const char* const unit = fact.path.ends_with(".young")   ? " Pa"
                                 : fact.path.ends_with("_speed") ? " m/s"
                                                                 : "";
        fmt::print("  {} {:.6g}{}\n", harmless(fact.path.substr(6)), fact.value, unit);
      }
    std::fflush(stdout);
    for (const std::string& warning : method->warnings())
      std::fputs(fmt::format("warning: {}\n", harmless(warning)).c_str(), stderr);
  }
};

}  // namespace

void add_check(CLI::App& program, int& exit_code) {
  const auto check = std::make_shared<CheckCommand>();
  CLI::App* const command =
      program.add_subcommand("check", "say every problem of cases without running them");
  command->add_option("CASE", check->paths, "case files, or folders that hold case.toml")
      ->required();
  command->add_option("--set", check->overrides, "override a key of the cases")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);
  command->add_flag("--model", check->model,
                    "also build and set up the models, and say what is doubtful about them");
  command->add_flag("--allow-scripts", check->allow_scripts, allow_scripts_help);
  command->callback([check, &exit_code] { exit_code = check->execute(); });
}

}  // namespace breccia::app
