#pragma once
// Stress at the start against what bears it on the border.

#include <string>
#include <vector>

#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia::prepare {

/// Borders of bodies at which nothing bears the stress in situ, so that they move from the first
/// step on; pressures on them of another size; stress that pulls. A sentence each. Of bodies that
/// are boxes, the sides of the box around all of them are looked at; of discs, rings, cylinders,
/// spheres and bodies from a file their own border.
std::vector<std::string> doubtful_in_situ(const fdem::Config& config, const std::string& folder);
std::vector<std::string> doubtful_in_situ(const fdem3::Config& config, const std::string& folder);

/// Materials that are too soft for the stress that they bear, at the start or from a stage on:
/// their elements would turn inside out. A sentence each.
std::vector<std::string> soft_problems(const fdem::Config& config);
std::vector<std::string> soft_problems(const fdem3::Config& config);

}  // namespace breccia::prepare
