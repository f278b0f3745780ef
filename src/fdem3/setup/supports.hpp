#pragma once
// Supports of a case: corners whose motion is prescribed.

#include "fdem3/world.hpp"

namespace breccia::fdem3 {

/// Which corners they hold, and the motion of held corners at the start.
void set_up_supports(World& w, const Config& config, const Model& model);

/// Each corner follows the sum of those that hold it, each in its own directions.
/// @returns the place in Case::holds of each tetrahedron of the whole mesh, -1: it is free
std::vector<Index> prescribe_supports(World& w, const Config& config);

}  // namespace breccia::fdem3
