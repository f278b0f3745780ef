#pragma once
// Triangles that lie in each other at the start.

#include <vector>

#include "prepare/meshing/mesh.hpp"

namespace breccia::prepare {

struct Overlap {
  Index a, b;  ///< triangles, a < b
};

/// Pairs of triangles without a common vertex that share more than 1e-6 of the smaller one's area;
/// sorted. Such a pair would fly apart in the first step.
std::vector<Overlap> overlaps_of(const std::vector<Vec2>& point,
                                 const std::vector<Triangle>& triangles);

/// The area that two counter-clockwise triangles share.  [m2]
double shared_area(const std::array<Vec2, 3>& a, const std::array<Vec2, 3>& b);

}  // namespace breccia::prepare
