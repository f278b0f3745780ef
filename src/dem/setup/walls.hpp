#pragma once
// From a case's walls to those of a world.

#include <string>
#include <vector>

#include "dem/setup/drive_config.hpp"
#include "dem/wall.hpp"

namespace breccia::dem {

/// Lengths that a wall's shape needs or cannot use, and turns that it cannot make.
std::vector<std::string> wall_problems(const WallConfig& config);

Wall wall_of(const WallConfig& config, const Vec3& velocity);

}  // namespace breccia::dem
