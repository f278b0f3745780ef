#pragma once
// Regular meshes of tetrahedra that need no mesh generator.

#include "core/random.hpp"
#include "prepare/tetrahedra/tet_mesh.hpp"

namespace breccia::prepare {

/// Cuboids, as near to cubes as whole numbers allow, each cut into the six tetrahedra of Kuhn
/// (1960): one for each order of the axes in which a path of three edges leads from the lowest
/// corner to the highest one. Neighbours fit without mirroring. All faces lie in nine families of
/// planes.
TetMesh kuhn_box(const Vec3& center, const Vec3& size, double edge);

/// Moves vertices that are not on the surface by up to `share` of the shortest edge there. No
/// tetrahedron loses more than half of its volume at one vertex's move; `fixed` vertices stay (may
/// be empty).
void jitter(TetMesh& mesh, double share, const Random& random, const std::vector<bool>& fixed);

}  // namespace breccia::prepare
