#pragma once
// Meshes made by the program gmsh, which runs beside Breccia and is never a part of it.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "prepare/meshing/mesh.hpp"
#include "prepare/meshing/run_gmsh.hpp"

namespace breccia::prepare {

/// A flat region to be meshed: an outer shape less holes and slots, and lines that edges follow.
struct Region {
  enum class Shape { disc, rectangle, polygon };
  struct Circle {
    Vec2 center;    ///<  [m]
    double radius;  ///<  [m]
  };

  Shape shape = Shape::rectangle;
  Circle disc{};
  Vec2 center{}, size{};        ///< of a rectangle  [m]
  std::vector<Vec2> polygon{};  ///< corners, either way round  [m]
  std::vector<Circle> holes{};
  std::vector<std::vector<Vec2>> slots{};    ///< polygons that are cut out, corners in order  [m]
  std::vector<std::array<Vec2, 2>> lines{};  ///< parts of them outside do not count  [m]
  double edge = 0.0;                         ///< edge length that is aimed at  [m]
};

/// The region in the language of gmsh.
std::string geo_text(const Region& region);

/// Triangles by gmsh's frontal Delaunay method on one thread: same region and seed, same bits, for
/// the same version of gmsh.
/// @throws InputError if gmsh is not installed, or what it says if it fails
Mesh mesh_region(const Region& region, std::int64_t seed);

/// A .geo file of the user.
/// @param edge  no edge is longer; 0: what the file says  [m]
Mesh mesh_geo_file(const std::string& path, double edge, std::int64_t seed);

/// As mesh_geo_file with a program of another name in place of gmsh, to test what its lack says.
Mesh mesh_geo_file_with(const std::string& program, const std::string& path, double edge,
                        std::int64_t seed);

}  // namespace breccia::prepare
