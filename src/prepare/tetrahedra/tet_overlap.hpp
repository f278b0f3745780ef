#pragma once
// Tetrahedra that lie in each other at the start.

#include <vector>

#include "prepare/tetrahedra/tet_check.hpp"

namespace breccia::prepare {

struct TetOverlap {
  Index a, b;  ///< tetrahedra, a < b
};

/// Pairs of tetrahedra without a common vertex that lie in each other by more than 1e-6 of the
/// smaller one's largest edge, and of which one at least has a face on the surface; sorted. Such a
/// pair would fly apart in the first step. Where bodies lie in each other, there is such a pair.
std::vector<TetOverlap> overlaps_of(const std::vector<Vec3>& point,
                                    const std::vector<Tetrahedron>& tetrahedra,
                                    const std::vector<MeshFace>& faces);

/// By how much two tetrahedra lie in each other along the axis along which it is least (normals of
/// faces, cross products of edges: the theorem of separating axes); 0 or less: not at all.  [m]
double shared_depth(const std::array<Vec3, 4>& a, const std::array<Vec3, 4>& b);

}  // namespace breccia::prepare
