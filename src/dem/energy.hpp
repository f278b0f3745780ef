#pragma once
// The ledger of spheres by parts: each rank sums up what it owns, and exact sums add up to those of
// the whole.

#include "dem/world.hpp"

namespace breccia::dem {

/// Energies in the ledger's columns.  [J]
struct Held {
  ExactSum kinetic, elastic, fracture, plastic, friction, damping, contact, work;
  ExactSum potential;  ///< sum of m g.x  [J]
};
Held operator+(Held a, const Held& b);

/// Those of a rank's own elements, and of the links and contacts whose first element it owns.
Held held(const World& w);

/// Adds to a ledger what a part has booked.
void add(Ledger& ledger, const Ledger& booked);

/// Where every joule of the whole is; keeps the largest energy seen in its ledger.
/// @param all   of all parts
/// @param step  at which they were held
EnergyBalance balance(Ledger& ledger, const Held& all, std::int64_t step);

}  // namespace breccia::dem
