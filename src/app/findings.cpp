#include "app/findings.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "core/case_config.hpp"
#include "exec/error.hpp"
#include "io/fold.hpp"
#include "io/harmless.hpp"
#include "io/whole_file.hpp"
#include "report/curves.hpp"
#include "report/findings.hpp"
#include "report/page.hpp"
#include "run/results/result_folder.hpp"
#include "run/run.hpp"

namespace breccia::app {
namespace {

/// Frames of larger files take longer to look at than a person waits.
constexpr std::uintmax_t largest_frame = 20'000'000;

bool has_small_frames(const std::string& folder) {
  std::error_code error;
  for (const auto& file : std::filesystem::directory_iterator(folder + "/fields", error))
    if (file.file_size(error) > largest_frame || error) return false;
  return !error;
}

}  // namespace

void tell_findings(const std::string& folder) {
  try {
    report::Record record = report::read_record(folder);
    if (!has_small_frames(folder)) record.times.clear();
    const char* head = "shows";
    for (const std::string& sentence : report::findings_of(record)) {
      std::fputs(fitting(fmt::format("{:<7} {}\n", head, harmless(sentence)), 8, stdout).c_str(),
                 stdout);
      head = "";
    }
  } catch (const Error&) {
    return;
  }
}

namespace {

void write_curves(const std::string& folder, const CaseConfig& config) {
  if (config.probes.empty()) return;
  const std::string curves = report::curves_of(report::read_record(folder));
  if (!curves.empty()) replace_file(folder + "/curves.svg", curves);
}

void tell_and_report(const std::string& folder, const CaseConfig& config, bool quiet) {
  if (!quiet) tell_findings(folder);
  write_curves(folder, config);
  if (!config.output.report) return;
  const std::string path = folder + "/report.html";
  replace_file(path, report::page_of({report::read_record(folder)}, std::nullopt).html);
  if (!quiet) std::fputs(fmt::format("report  {}\n", harmless(path)).c_str(), stdout);
}

}  // namespace

int execute_and_tell(Run& run, const ResultFolder* folder, const CaseConfig& config, bool quiet) {
  // Of a run that fails or ends early the reason is the one thing to tell, whatever becomes of what
  // it leaves.
  const auto leave = [&](const auto& work) {
    try {
      if (folder != nullptr) work();
    } catch (const std::exception&) {
      return;
    }
  };
  const auto leave_curves = [&] { leave([&] { write_curves(folder->path(), config); }); };
  int exit_code = 0;
  try {
    exit_code = run.execute();
  } catch (const CheckFailed&) {  // the run ended well; its failed check is the one error to tell
    leave([&] { tell_and_report(folder->path(), config, quiet); });
    throw;
  } catch (...) {
    leave_curves();
    throw;
  }
  if (exit_code != 0)
    leave_curves();
  else if (folder != nullptr)
    tell_and_report(folder->path(), config, quiet);
  return exit_code;
}

}  // namespace breccia::app
