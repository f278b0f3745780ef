#pragma once
// Spheres that begin inside of tetrahedra.

#include <string>
#include <vector>

#include "coupled/setup/config.hpp"

namespace breccia::prepare {

/// Bodies of spheres (boxes, balls, single elements) that reach into boxes of tetrahedra at the
/// start, by more than a fiftieth of their own size; a sentence each. Bars, and bodies that a
/// [[bond]] ties to the other, may lie there.
std::vector<std::string> doubtful_bodies(const coupled::Config& config, const std::string& folder);

}  // namespace breccia::prepare
