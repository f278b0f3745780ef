#pragma once
// Rock bolts of a case of triangles: fdem_shared/setup/bolts.hpp.

#include <string>
#include <vector>

#include "fdem/setup/config.hpp"

namespace breccia::fdem {

/// Problems of bolts that a case file alone tells of.
std::vector<std::string> bolt_problems(const Config& config);

}  // namespace breccia::fdem
