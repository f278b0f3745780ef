#pragma once
// Which triangles of a mesh are neighbours.

#include <vector>

#include "fdem/setup/model.hpp"

namespace breccia::fdem {

/// An edge of the mesh with the one or two triangles that have it.
struct MeshEdge {
  Index low, high;  ///< its vertices
  Index a, b = -1;  ///< edges 3 t + k of the triangles, that of the lower triangle first; -1: none
};

/// All edges, by their vertices. @throws InputError if three triangles share one, or two run along
/// it in the same direction
std::vector<MeshEdge> mesh_edges(const Model& model);

}  // namespace breccia::fdem
