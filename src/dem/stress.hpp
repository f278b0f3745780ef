#pragma once
// Stress of each element.

#include <array>
#include <vector>

#include "dem/world.hpp"

namespace breccia::dem {

/// xx, yy, zz, xy, yz, xz; tension is positive.  [Pa]
using Stress = std::array<double, 6>;

/// Mean stress of the volume of each element, that of the body its mass makes up: the symmetric
/// part of the sum of forces times the ways from its centre to where they act, over that volume
/// (Weber; Love). The mean over a body, by volume, is that of a probe of stress of a box around it.
/// Values of ghosts mean nothing. Equal on any number of ranks.
std::vector<Stress> stresses(const World& w);

}  // namespace breccia::dem
