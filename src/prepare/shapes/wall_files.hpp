#pragma once
// Walls whose surface is in an STL file.

#include <string>
#include <vector>

#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"

namespace breccia::prepare {

/// Corners of the triangles of a wall, three each.  [m]
/// @throws as read_surface, and InputError where the triangles are unfit for a wall
std::vector<Vec3> corners_of_wall(const dem::WallConfig& wall, const std::string& case_folder);

/// Reads the files of all walls that have one.
void add_wall_meshes(dem::Model& model, const dem::Config& config, const std::string& case_folder);

}  // namespace breccia::prepare
