// breccia info FILE: what a checkpoint, a model or a result folder holds.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands.hpp"
#include "exec/error.hpp"
#include "io/checkpoint.hpp"
#include "io/harmless.hpp"
#include "io/round_numbers.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/whole_file.hpp"
#include "run/results/checkpoints.hpp"

namespace breccia::app {
namespace {

namespace fs = std::filesystem;

/// Prints what files say, which must not steer the terminal.
template <class... Values>
void print_harmless(fmt::format_string<Values...> form, Values&&... values) {
  fmt::print("{}", harmless(fmt::format(form, std::forward<Values>(values)...)));
}

void describe_state(const std::string& path) {
  const CheckpointReader reader(path);
  print_harmless("{}\n", path);
  if (reader.has("run.case_name"))
    print_harmless("  a state of case {} ({}, {} precision), step {}, {}\n",
                   reader.text("run.case_name"), reader.text("run.method"),
                   reader.has("run.precision") ? reader.text("run.precision") : "double",
                   count_text(static_cast<double>(reader.value<std::int64_t>("run.step"))),
                   time_text(reader.value<double>("run.time")));
  if (reader.has("case.name")) print_harmless("  the model of case {}\n", reader.text("case.name"));
  print_harmless("  {:<32} {:>12} {:>12}\n", "section", "items", "bytes");
  for (const CheckpointReader::Section& section : reader.sections())
    print_harmless("  {:<32} {:>12} {:>12}\n", section.name, section.count, section.bytes.size());
}

void describe_folder(const std::string& path) {
  const std::string summary = path + "/summary.json";
  if (!fs::exists(summary))
    throw InputError(path + ": this folder holds no run (there is no summary.json)");
  print_harmless("{}", read_whole_file(summary));
  if (holds_frames(path)) {
    const std::vector<double> times = frame_times(path);
    if (!times.empty())
      print_harmless("frames: {}, from {} to {}\n", times.size(), time_text(times.front()),
                     time_text(times.back()));
  }
  for (const CheckpointFile& file : list_checkpoints(path + "/checkpoints"))
    print_harmless("checkpoint: {}, step {}\n", file.path,
                   count_text(static_cast<double>(file.step)));
}

void describe_table(const std::string& path) {
  const std::string text = read_whole_file(path);
  const std::size_t names_end = text.find('\n');
  const std::size_t units_end = text.find('\n', names_end + 1);
  if (units_end == std::string::npos) throw InputError(path + ": this is no history of a run");
  const auto lines = std::count(text.begin(), text.end(), '\n');
  print_harmless("{}\n  {} rows\n  columns: {}\n  units:   {}\n", path, lines - 2,
                 text.substr(0, names_end), text.substr(names_end + 1, units_end - names_end - 1));
}

void describe(const std::string& path) {
  if (fs::is_directory(path)) return describe_folder(path);
  const std::string kind = fs::path(path).extension().string();
  if (kind == ".csv") return describe_table(path);
  if (kind == ".json" || kind == ".toml") {
    print_harmless("{}", read_whole_file(path));
    return;
  }
  describe_state(path);
}

}  // namespace

void add_info(CLI::App& program) {
  const auto path = std::make_shared<std::string>();
  CLI::App* const command =
      program.add_subcommand("info", "what a checkpoint, model or result folder holds");
  command->add_option("FILE", *path, "a file a run left, or its folder")->required();
  command->callback([path] { describe(*path); });
}

}  // namespace breccia::app
