#pragma once
// The balance of a model whose joints crack in two modes.

#include <algorithm>
#include <cmath>

#include "core/energy.hpp"

namespace breccia {

struct EnergySplit {
  EnergyBalance balance;
  double fracture_open = 0.0, fracture_slide = 0.0;  ///< of fracture, by mode  [J; in 2D J/m]
};

/// The largest sum of energies and work seen, now included.  [J; in 2D J/m]
inline double largest_with(const Ledger& ledger, const EnergyBalance& b) {
  return std::max({ledger.largest, b.total(), b.start + std::abs(b.work),
                   std::abs(b.start) + std::abs(b.work)});
}

inline EnergySplit split_of(const Ledger& ledger, const Energies& s) {
  EnergySplit split;
  split.fracture_open = s.fracture.value();
  split.fracture_slide = s.sliding.value();
  EnergyBalance& b = split.balance;
  b.kinetic = s.kinetic.value();
  b.elastic = s.elastic.value();
  b.fracture = split.fracture_open + split.fracture_slide;
  b.friction = s.friction.value() + ledger.friction.value();
  b.damping = s.damping.value();
  b.contact = s.contact.value() + ledger.contact.value();
  b.work = s.work.value() + s.potential.value() - ledger.start_potential.value();
  b.start = ledger.start + ledger.came_in.value();
  b.relate_to(largest_with(ledger, b));
  return split;
}
/// Likewise, and keeps the largest energy seen, for the relative error.
inline EnergySplit split_and_note(Ledger& ledger, const Energies& all) {
  const EnergySplit split = split_of(ledger, all);
  ledger.largest = largest_with(ledger, split.balance);
  return split;
}

}  // namespace breccia
