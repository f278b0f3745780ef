#pragma once
// From a case's walls to those of a world.

#include <string>
#include <vector>

#include "dem/case.hpp"
#include "dem/setup/drive_config.hpp"
#include "dem/wall.hpp"

namespace breccia::dem {

/// Lengths that a wall's shape needs or cannot use, turns that it cannot make, and what goes with a
/// mass only or not at all.
std::vector<std::string> wall_problems(const WallConfig& config);

Wall wall_of(const WallConfig& config, const Vec3& velocity);

/// Its mass, where it moves, and the force that the case gives.
/// @param mass_scaling  of the case  [-]
FreeWall free_wall_of(const WallConfig& config, double mass_scaling);

/// Of all walls, as they turn over time; empty: no table tells how one does.
std::vector<WallSpin> wall_spins(const std::vector<WallConfig>& walls);

}  // namespace breccia::dem
