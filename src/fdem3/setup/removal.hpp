#pragma once
// Bodies that a stage takes out of the model: fdem_shared/setup/removal.hpp for tetrahedra.

#include "fdem3/world.hpp"

namespace breccia::fdem3 {

/// Of each tetrahedron of this world: 1 if it is gone.
std::vector<std::uint8_t> gone_tetrahedra(const World& w);

}  // namespace breccia::fdem3
