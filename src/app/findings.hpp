#pragma once

#include <string>

namespace breccia {
struct CaseConfig;
}

namespace breccia::app {

/// Prints what a run shows, in up to three sentences, from its result folder; what cannot be read
/// is not told.
void tell_findings(const std::string& folder);

/// That, unless `quiet`. Writes report.html, if the case asks for it.
/// @throws IoError if the report cannot be written
void tell_and_report(const std::string& folder, const CaseConfig& config, bool quiet);

}  // namespace breccia::app
