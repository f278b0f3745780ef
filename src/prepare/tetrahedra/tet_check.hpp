#pragma once
// Conditions that every mesh of tetrahedra must meet, wherever it comes from.

#include <functional>
#include <string>
#include <vector>

#include "prepare/tetrahedra/tet_mesh.hpp"

namespace breccia::prepare {

/// A face and the tetrahedra on its two sides; the second is -1 at the surface.
struct MeshFace {
  Face corners;  ///< ascending
  std::array<Index, 2> tetrahedra;
};

/// Every face once, sorted by its corners. Of a face with more than two tetrahedra, the first two.
std::vector<MeshFace> faces_of(const std::vector<Tetrahedron>& tetrahedra);

/// The face of these corners, ascending; nullptr if there is none.
const MeshFace* find_face(const std::vector<MeshFace>& faces, const Face& corners);

/// How messages name a tetrahedron or a vertex, given its index.
struct TetNames {
  std::function<std::string(Index)> tetrahedron, vertex;
};
/// "tetrahedron 4", "vertex 17", counted from 0.
TetNames plain_tet_names();

/// One sentence for each thing that is wrong, at most `most` of each kind: corners that do not
/// exist or coincide, points that are not finite, tetrahedra that are turned inside out, have no
/// volume or come twice, faces of three tetrahedra, neighbours that overlap, vertices without a
/// tetrahedron.
std::vector<std::string> mesh_problems(const TetMesh& mesh, const TetNames& names,
                                       std::size_t most = 5);

/// @throws InputError with all problems at once
void check_mesh(const TetMesh& mesh);

}  // namespace breccia::prepare
