#pragma once
// The ledger of a mesh by parts: each rank sums up what it owns, and exact sums add up to those of
// the whole.

#include "fdem/world.hpp"

namespace breccia::fdem {

/// Energies of one item or of many, in the ledger's columns.  [J/m]
struct Shares {
  ExactSum kinetic, elastic, open, slide, friction, damping, contact, work;
};
BR_HD inline Shares operator+(Shares a, const Shares& b) {
  a.kinetic.add(b.kinetic);
  a.elastic.add(b.elastic);
  a.open.add(b.open);
  a.slide.add(b.slide);
  a.friction.add(b.friction);
  a.damping.add(b.damping);
  a.contact.add(b.contact);
  a.work.add(b.work);
  return a;
}

/// What triangles, joints and couples hold and have spent.
struct Held {
  Shares shares;
  ExactSum potential;  ///< sum of m g.x  [J/m]
};
inline Held operator+(Held a, const Held& b) {
  a.shares = a.shares + b.shares;
  a.potential.add(b.potential);
  return a;
}

/// That of a rank's own triangles, and of the joints and couples whose first triangle it owns.
Held held(const World& w);

/// Adds to a ledger what a part has booked.
void add(Ledger& ledger, const Ledger& booked);

/// Where every joule of the whole is; keeps the largest energy seen in its ledger.
/// @param all  of all parts
EnergySplit energies(Ledger& ledger, const Held& all);
inline EnergyBalance balance(Ledger& ledger, const Held& all, std::int64_t /*step*/) {
  return energies(ledger, all).balance;
}

}  // namespace breccia::fdem
