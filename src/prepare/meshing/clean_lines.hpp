#pragma once
// Lines that a mesh follows, without the small distances between them that would make slivers.

#include <array>
#include <vector>

#include "math/vec2.hpp"

namespace breccia::prepare {

/// Merges what lies nearer than a tolerance: ends and crossings of lines with each other, ends with
/// lines that they nearly reach or overshoot. Nothing moves farther than a few tolerances. Points
/// near the rim move onto it.
/// @param lines      each from one point to another
/// @param rim        lines of the outline, which stay where they are; may be empty
/// @param tolerance  [m]
/// @returns the lines as they are if nothing is so near; otherwise parts of them that meet at
///          their ends only
std::vector<std::array<Vec2, 2>> cleaned(const std::vector<std::array<Vec2, 2>>& lines,
                                         const std::vector<std::array<Vec2, 2>>& rim,
                                         double tolerance);

}  // namespace breccia::prepare
