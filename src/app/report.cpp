// breccia report DIR: one HTML file about a run, or about two beside each other.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "exec/error.hpp"
#include "io/harmless.hpp"
#include "io/whole_file.hpp"
#include "report/page.hpp"

namespace breccia::app {
namespace {

bool is_plane(const report::Record& run) {
  return run.text("method").ends_with("2d");
}

struct ReportCommand {
  std::vector<std::string> folders;
  std::string data, file;

  void execute() const {
    if (!file.empty() && !file.ends_with(".html"))
      throw InputError(file + ": reports are HTML files; end the name with .html");
    std::optional<report::Measured> measured;
    if (!data.empty())
      measured = {std::filesystem::path(data).filename().string(), report::read_measured(data)};
    std::vector<report::Record> runs;
    for (const std::string& folder : folders) runs.push_back(report::read_record(folder));
    if (runs.size() == 2 && is_plane(runs[0]) != is_plane(runs[1]))
      throw InputError(
          fmt::format("{} is a run in a plane and {} one in space: one camera cannot show both",
                      folders[is_plane(runs[0]) ? 0 : 1], folders[is_plane(runs[0]) ? 1 : 0]));
    const report::Page page = report::page_of(runs, measured);
    const std::string path = file.empty() ? folders.front() + "/report.html" : file;
    replace_file(path, page.html);
    fmt::print("{}  {:.2f} MB, open it in a browser\n", harmless(path),
               static_cast<double>(page.html.size()) / 1e6);
    for (const std::string& note : page.notes) fmt::print("  {}\n", harmless(note));
  }
};

}  // namespace

void add_report(CLI::App& program) {
  const auto report = std::make_shared<ReportCommand>();
  CLI::App* const command = program.add_subcommand(
      "report", "write one HTML file about a run: a turning view, curves, cracks, checks");
  command->add_option("DIR", report->folders, "result folders: of a run, or of two to compare")
      ->required()
      ->expected(1, 2);
  command
      ->add_option("--data", report->data,
                   "measurements to draw over the run's curves: names in the first line, x first")
      ->type_name("FILE.csv");
  command->add_option("-o,--out", report->file, "the report; default: DIR/report.html")
      ->type_name("FILE.html");
  command->callback([report] { report->execute(); });
}

}  // namespace breccia::app
