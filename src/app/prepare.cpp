// breccia prepare CASE: builds the model of a case and saves it, so that a run need not.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "app/option_kinds.hpp"
#include "io/checkpoint.hpp"
#include "run/case.hpp"
#include "run/machine/exec_choice.hpp"

namespace breccia::app {
namespace {

struct PrepareCommand {
  std::string path, file;
  std::vector<std::string> overrides;
  bool allow_scripts = false;

  void execute() const {
    const Case read = load_case(path, overrides);
    if (!allow_scripts) refuse_scripts(read);
    const std::string target = file.empty() ? read.name + ".br" : file;
    CheckpointWriter writer;
    writer.text("case.name", read.name);
    writer.text("case.folder", read.folder);
    writer.text("case.text", read.text);
    const std::string size = save_model_of(read, writer, exec_on("cpu", 0, nullptr));
    writer.write(target);
    fmt::print("{}  {}\n", target, size);
  }
};

}  // namespace

void add_prepare(CLI::App& program) {
  const auto prepare = std::make_shared<PrepareCommand>();
  CLI::App* const command =
      program.add_subcommand("prepare", "build the model of a case; run accepts it as CASE");
  command->add_option("CASE", prepare->path, "a case file, or a folder that holds case.toml")
      ->required();
  command->add_option("-o,--out", prepare->file, "the model; default: <case name>.br")
      ->type_name("MODEL.br");
  add_repeated(command, "--set", prepare->overrides, "override a key of the case", "KEY=VALUE");
  command->add_flag("--allow-scripts", prepare->allow_scripts, allow_scripts_help);
  command->callback([prepare] { prepare->execute(); });
}

}  // namespace breccia::app
