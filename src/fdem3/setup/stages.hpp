#pragma once
// A case as it is in one of its stages.

#include <string>
#include <vector>

#include "fdem3/setup/config.hpp"

namespace breccia::fdem3 {

/// With all that the stages up to the present one have changed.
Config config_at(Config config, const StageProgress& progress);

/// Names that lead nowhere, and ends that do not come.
std::vector<std::string> stage_problems(const Config& config);

}  // namespace breccia::fdem3
