#pragma once
// The ledger of spheres by parts: each rank sums up what it owns, and exact sums add up to those of
// the whole.

#include "dem/world.hpp"

namespace breccia::dem {

/// Energies of a rank's own elements, and of the links and contacts whose first element it owns.
Energies held(const World& w);

/// Where every joule of the whole is; keeps the largest energy seen in its ledger.
/// @param all   of all parts
/// @param step  at which they were held
EnergyBalance balance(Ledger& ledger, const Energies& all, std::int64_t step);

}  // namespace breccia::dem
