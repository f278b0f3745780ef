#pragma once
// An order of vertices and triangles in memory that follows space.

#include "fdem/setup/model.hpp"

namespace breccia::prepare {

/// Position of a cell on Hilbert's curve through 2^16 x 2^16 cells.
std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y);

/// Triangles along Hilbert's curve through their centroids, vertices as the triangles come to them.
void order_along_curve(fdem::Model& model);

}  // namespace breccia::prepare
