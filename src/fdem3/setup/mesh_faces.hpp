#pragma once
// Faces of a mesh of tetrahedra and the neighbours across them.

#include <array>
#include <vector>

#include "fdem3/setup/model.hpp"

namespace breccia::fdem3 {

/// A face: number 4 t + k on its one or two sides.
struct MeshFace {
  std::array<Index, 3> corners;  ///< vertices, ascending
  Index a, b;                    ///< a of the lower number; b = -1: on the border
};

/// All faces, in ascending order of `a`. @throws InputError if three tetrahedra share one
std::vector<MeshFace> mesh_faces(const Model& model);

}  // namespace breccia::fdem3
