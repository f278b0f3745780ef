#pragma once

#include <string>

namespace breccia {
struct CaseConfig;
class ResultFolder;
class Run;
}  // namespace breccia

namespace breccia::app {

/// Prints what a run shows, in up to three sentences, from its result folder; what cannot be read
/// is not told.
void tell_findings(const std::string& folder);

/// Carries a run out. However it ends it leaves curves.svg, if it has probes; at a good end it
/// tells its findings, unless `quiet`, and leaves report.html, if the case asks for it.
/// @param folder  null: this process writes none
/// @returns the exit code of the run
/// @throws what the run does; IoError if the curves or the report of a good run cannot be written
int execute_and_tell(Run& run, const ResultFolder* folder, const CaseConfig& config, bool quiet);

}  // namespace breccia::app
