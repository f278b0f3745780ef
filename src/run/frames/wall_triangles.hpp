#pragma once
// Walls that end, as triangles.

#include <vector>

#include "dem/wall.hpp"

namespace breccia {

/// Corners of the triangles of a wall's surface, three each; of a plane, which has no end, none.
/// Cylinders have 32 sides, spheres 32 by 16 faces.  [m]
std::vector<Vec3> wall_triangles(const dem::Wall& wall);

}  // namespace breccia
