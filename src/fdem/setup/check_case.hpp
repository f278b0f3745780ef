#pragma once

#include <string>
#include <vector>

#include "fdem/setup/config.hpp"

namespace breccia::fdem {

/// Names that lead nowhere and tables that do not fit, one sentence each. Rules for bodies are in
/// prepare/checks/check_bodies.hpp.
std::vector<std::string> case_problems(const Config& config);

}  // namespace breccia::fdem
