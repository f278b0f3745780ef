#pragma once
// An order of vertices and tetrahedra in memory that follows space.

#include "fdem3/setup/model.hpp"

namespace breccia::prepare {

/// Position of a cell on Hilbert's curve through 2^21 x 2^21 x 2^21 cells (Skilling 2004,
/// "Programming the Hilbert curve").
std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, std::uint32_t z);

/// Tetrahedra along Hilbert's curve through their centroids, vertices as the tetrahedra come to
/// them. Vertices without a tetrahedron are dropped.
void order_along_curve(fdem3::Model& model);

}  // namespace breccia::prepare
