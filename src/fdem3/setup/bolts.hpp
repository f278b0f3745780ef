#pragma once
// Rock bolts of a case of tetrahedra: fdem_shared/setup/bolts.hpp.

#include <string>
#include <vector>

#include "fdem3/setup/config.hpp"

namespace breccia::fdem3 {

/// Problems of bolts that a case file alone tells of: how stiff corners are follows from the mesh.
std::vector<std::string> bolt_problems(const Config& config);

}  // namespace breccia::fdem3
