#pragma once
// Widths of lines that a field colours.

#include <vector>

#include "io/picture/field_colors.hpp"

namespace breccia {

/// Wide lines for large values; those of the smallest, which would cover the others, are left out.
void size_lines(const std::vector<float>& values, Coloring& coloring);

/// Broken joints over the bodies, by mode: opened, slid, or of both; cracks open from the start.
void show_cracks(const Frame& frame, Coloring& coloring);

}  // namespace breccia
