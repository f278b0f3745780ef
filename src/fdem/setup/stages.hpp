#pragma once
// A case as it is in one of its stages.

#include <string>
#include <vector>

#include "fdem/setup/config.hpp"

namespace breccia::fdem {

/// The case with what its stages up to the present one have changed.
Config config_at(Config config, const StageProgress& progress);

/// Problems of the stages of a case, as sentences.
std::vector<std::string> stage_problems(const Config& config);

}  // namespace breccia::fdem
