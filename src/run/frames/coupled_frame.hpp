#pragma once
// Forces between spheres and tetrahedra, as output sees them.

#include <vector>

#include "coupled/world.hpp"
#include "io/frame.hpp"

namespace breccia {

/// Adds spheres that press on tetrahedra, by the forces of the last step, friction with them: from
/// centres to centroids. Ids of tetrahedra count on behind those of spheres (io/frame_pair.hpp).
void add_presses(const coupled::World& w, std::vector<FrameContact>& contacts);

}  // namespace breccia
