#pragma once
// Acoustic emission of links that broke.

#include <vector>

#include "core/emission.hpp"
#include "dem/world.hpp"

namespace breccia::dem {

/// Events of cohesive links and parallel bonds, by the rows of the history that found them broken.
/// A link of stiffness K and length D whose rupture spent W is a dipole along it, of the force that
/// would have stored as much: M = D sqrt(2 K W) n n; of a brittle link that is its strength times
/// its length. Two are near as the case says, or if they are two mean diameters apart, and the time
/// that the slowest chain of such links takes for it.
std::vector<EmissionEvent> emission(const World& whole);

}  // namespace breccia::dem
