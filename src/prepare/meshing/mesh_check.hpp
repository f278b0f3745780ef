#pragma once
// Conditions that every mesh must meet, wherever it comes from.

#include <functional>
#include <string>
#include <vector>

#include "prepare/meshing/mesh.hpp"

namespace breccia::prepare {

/// An edge and the triangles on its two sides; the second is -1 at the rim.
struct MeshEdge {
  Edge ends;  ///< the smaller vertex first
  std::array<Index, 2> triangles;
};

/// Every edge once, sorted by its ends. Of an edge with more than two triangles, the first two.
std::vector<MeshEdge> edges_of(const std::vector<Triangle>& triangles);

/// How messages name a triangle or a vertex, given its index.
struct MeshNames {
  std::function<std::string(Index)> triangle, vertex;
};
/// "triangle 4", "vertex 17", counted from 0.
MeshNames plain_names();

/// One sentence for each thing that is wrong, at most `most` of each kind: corners that do not
/// exist or coincide, points that are not finite, triangles that are clockwise, have no area or
/// come twice, edges of three triangles, neighbours that overlap, vertices without a triangle.
std::vector<std::string> mesh_problems(const Mesh& mesh, const MeshNames& names,
                                       std::size_t most = 5);

/// @throws InputError with all problems at once
void check_mesh(const Mesh& mesh);

}  // namespace breccia::prepare
