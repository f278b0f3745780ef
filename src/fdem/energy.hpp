#pragma once
// The ledger of a mesh by parts: each rank sums up what it owns, and exact sums add up to those of
// the whole.

#include "fdem/world.hpp"

namespace breccia::fdem {

/// Energies that a rank's own triangles hold and have spent, and the joints and couples whose first
/// triangle it owns.
Energies held(const World& w);

/// Where every joule of the whole is; keeps the largest energy seen in its ledger.
/// @param all  of all parts
EnergySplit energies(Ledger& ledger, const Energies& all);

}  // namespace breccia::fdem
