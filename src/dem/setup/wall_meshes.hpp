#pragma once
// Walls of triangles: from the corners of a file to what kernels walk through.

#include <string>
#include <vector>

#include "dem/case.hpp"
#include "dem/setup/model.hpp"

namespace breccia::dem {

/// Triangles of one wall at most.
inline constexpr std::size_t most_mesh_triangles = 1'000'000;

/// The reason why triangles are unfit for a wall; empty: they are fit.
/// @param corners  three of each triangle  [m]
std::string wall_mesh_problem(const std::vector<Vec3>& corners);

/// Trees and neighbours of the walls of triangles of a case, in a space.
/// @throws InputError if the model has not the triangles of each of these walls, or unfit ones
WallMeshes wall_meshes(const Config& config, const Model& model, Space space);

/// How far the farthest corner is from the origin of the mesh.  [m]
double farthest_corner(const std::vector<Vec3>& corners);

}  // namespace breccia::dem
