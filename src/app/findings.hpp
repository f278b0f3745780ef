#pragma once

#include <string>

namespace breccia::app {

/// Prints what a finished run shows, in up to three sentences, from its result folder. What cannot
/// be read is not told: the run itself went well.
void tell_findings(const std::string& folder);

}  // namespace breccia::app
