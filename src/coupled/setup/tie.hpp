#pragma once
// Which spheres are tied to which faces.

#include <string>
#include <vector>

#include "coupled/world.hpp"

namespace breccia::coupled {

/// Each sphere of the one body is tied to the faces of the other one that are near: at the point
/// that is nearest, once where faces share it. Bonds have the area of all faces that are tied,
/// shared by the sections of their spheres.
/// @param law  number of the bonds' law
/// @param elements, solids  of both worlds, on the host
/// @throws InputError if no sphere is near
std::vector<BallBond> ties_of(const BondConfig& bond, Index law, const World& w,
                              const dem::Elements& elements, const fdem3::Tetrahedra& solids);

}  // namespace breccia::coupled
