#pragma once
// Stress at the start against what bears it on borders that are no sides of a box.

#include <string>
#include <vector>

#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia::prepare {

/// Discs, rings, cylinders, spheres, turned boxes and bodies from files whose border bears less
/// than the stress in situ, or a pressure of another size, so that it moves from the first step on.
/// Places at which another body lies are left out. A sentence each.
/// @param folder  of the case
std::vector<std::string> doubtful_round_borders(const fdem::Config& config,
                                                const std::string& folder);
std::vector<std::string> doubtful_round_borders(const fdem3::Config& config,
                                                const std::string& folder);

}  // namespace breccia::prepare
