#pragma once
// Centre of mass and inertia of rigid walls, as solids of even density.

#include <vector>

#include "dem/case.hpp"
#include "dem/setup/drive_config.hpp"

namespace breccia::dem {

/// Of a box, cylinder (with or without a nose), sphere, or the solid in a closed surface.
///
/// @param mass     of the wall  [kg]
/// @param corners  of a surface: three of each triangle, anticlockwise seen from outside  [m]
MassSpread mass_spread(const WallConfig& wall, double mass, const std::vector<Vec3>& corners);

/// Volume that a closed surface encloses; below 0 where its triangles are turned over.  [m3]
double enclosed_volume(const std::vector<Vec3>& corners);

}  // namespace breccia::dem
