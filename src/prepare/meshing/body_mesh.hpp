#pragma once
// The mesh of one FDEM body.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "fdem/setup/body_config.hpp"
#include "prepare/meshing/mesh.hpp"

namespace breccia::prepare {

/// Data of the case, besides its own keys, that a body's mesh depends on.
struct MeshingContext {
  std::int64_t seed = 1;
  std::uint32_t number = 0;                ///< of the body: streams of random numbers
  std::string folder;                      ///< of the files
  std::vector<std::array<Vec2, 2>> lines;  ///< that new meshes follow  [m]
};

/// Meshes, moves to its centre and jitters a body, and checks the result.
/// @throws InputError that does not name the body
Mesh mesh_of(const fdem::BodyConfig& body, const MeshingContext& context);

/// How many ends of the lines that its mesh is to follow `merge` moves, and how far; empty: none.
std::string merged_lines(const fdem::BodyConfig& body, const MeshingContext& context);

/// Whether the body's mesh is made by gmsh.
bool needs_gmsh(const fdem::BodyConfig& body);

/// The triangles of a mesh that are a body: those of its parts, or all.
/// @throws InputError if the mesh has no part of a name
std::vector<Index> triangles_of(const fdem::BodyConfig& body, const Mesh& mesh);

/// A polygon of x,y in metres, closed by itself and counter-clockwise however it is listed. A last
/// point that repeats the first is dropped.
/// @throws InputError if it has fewer than three corners, no area, or crosses itself
std::vector<Vec2> read_outline(const std::string& path);

/// Whether a point lies in a body of shape part.
bool in_part(const fdem::BodyConfig& part, const Vec2& x);
/// Adds the outline of a body of shape part.
/// @param edge  of the mesh of the body that it is a part of; 0: unknown  [m]
void add_outline(const fdem::BodyConfig& part, double edge,
                 std::vector<std::array<Vec2, 2>>& lines);

/// The distance of a point from a straight line between two points.  [m]
double distance(const Vec2& point, const std::array<Vec2, 2>& line);

}  // namespace breccia::prepare
