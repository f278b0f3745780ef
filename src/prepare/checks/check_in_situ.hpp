#pragma once
// Stress at the start against what bears it on the border.

#include <string>
#include <vector>

#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia::prepare {

/// Sides of the box around all bodies at which nothing bears the stress in situ, so that they move
/// from the first step on; pressures on them of another size; stress that pulls. A sentence each.
/// Round bodies and those of files are not looked at.
std::vector<std::string> doubtful_in_situ(const fdem::Config& config, const std::string& folder);
std::vector<std::string> doubtful_in_situ(const fdem3::Config& config, const std::string& folder);

}  // namespace breccia::prepare
