#pragma once
// The ledger of spheres by parts: each rank sums up what it owns, and exact sums add up to those of
// the whole.

#include <functional>

#include "dem/world.hpp"

namespace breccia::dem {

/// Energies of a rank's own elements, and of the links and contacts whose first element it owns, as
/// they are now, when they are asked for: until then the host can go on.
std::function<Energies()> held_later(const World& w);
inline Energies held(const World& w) {
  return held_later(w)();
}

/// Where every joule of the whole is; keeps the largest energy seen in its ledger.
/// @param all   of all parts
/// @param step  at which they were held
EnergyBalance balance(Ledger& ledger, const Energies& all, std::int64_t step);

}  // namespace breccia::dem
