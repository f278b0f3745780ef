#pragma once
// A model of deformable triangles on the host, ready to be set up.

#include <array>
#include <string>
#include <vector>

#include "exec/types.hpp"
#include "math/vec2.hpp"

namespace breccia::fdem {

/// A case's model, made by prepare and made a world by fdem/setup. Triangle t has global id t.
/// Triangles that share two vertices are neighbours; set-up joins them where a joint law is given
/// for their materials, and splits the mesh, so that each triangle owns its three nodes.
struct Model {
  std::vector<Vec2> point;                     ///< vertices  [m]
  std::vector<std::array<Index, 3>> triangle;  ///< corners, counter-clockwise, into point
  std::vector<std::string> groups;             ///< names of the bodies
  std::vector<std::int16_t> group;             ///< of each triangle, index into groups
  std::vector<std::int16_t> material;          ///< of each triangle, index into Config::materials
  std::vector<Vec2> velocity;                  ///< of each triangle at the start  [m/s]
  std::vector<float> strength;                 ///< of each triangle, over its material's  [-]

  /// A set of edges with a name: physical lines of a mesh file.
  struct EdgeSet {
    std::string name;
    std::vector<std::array<Index, 2>> edges;  ///< pairs of vertices
  };
  std::vector<EdgeSet> edge_sets;

  /// An edge of a discontinuity: its joint is broken at the start, or has a material of its own; or
  /// one within a quadrangle, whose triangles move as one. Of one edge the last counts.
  struct Discontinuity {
    std::array<Index, 2> edge;  ///< vertices
    std::int16_t material;      ///< of its joint, index into Config::joints; -1: open; or as_one
  };
  static constexpr std::int16_t as_one = -2;
  std::vector<Discontinuity> discontinuities;

  Index size() const { return static_cast<Index>(triangle.size()); }
};

}  // namespace breccia::fdem
