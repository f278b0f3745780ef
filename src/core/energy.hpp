#pragma once
// The ledger: where every joule is. Sums are exact, so their order cannot matter.

#include <cmath>

#include "core/exact_sum.hpp"

namespace breccia {

/// Energies of items, of a part or of all of a model, by the columns of the ledger  [J; in 2D J/m].
/// @tparam Sum  ExactSum, or PackSum of items side by side
template <class Sum>
struct EnergiesBy {
  using Part = Sum;
  static constexpr int parts = 10;

  Sum kinetic, elastic;
  Sum fracture;  ///< where modes are told apart: by opening
  Sum sliding;   ///< fracture by sliding
  Sum plastic, friction, damping, contact, work;
  Sum potential;  ///< sum of m g.x: gravity has done work where it falls
};
using Energies = EnergiesBy<ExactSum>;
/// Energies of one item (R = double) or of a pack.
template <class R>
using EnergiesOf = EnergiesBy<SumOf<R>>;
BR_HD inline Energies operator+(Energies a, const Energies& b) {
  a.kinetic.add(b.kinetic);
  a.elastic.add(b.elastic);
  a.fracture.add(b.fracture);
  a.sliding.add(b.sliding);
  a.plastic.add(b.plastic);
  a.friction.add(b.friction);
  a.damping.add(b.damping);
  a.contact.add(b.contact);
  a.work.add(b.work);
  a.potential.add(b.potential);
  return a;
}

/// Adds what items side by side have.
template <class R>
inline void add_packs(Energies& to, const EnergiesOf<R>& packs) {
  to.kinetic.add(packs.kinetic.sum());
  to.elastic.add(packs.elastic.sum());
  to.fracture.add(packs.fracture.sum());
  to.sliding.add(packs.sliding.sum());
  to.plastic.add(packs.plastic.sum());
  to.friction.add(packs.friction.sum());
  to.damping.add(packs.damping.sum());
  to.contact.add(packs.contact.sum());
  to.work.add(packs.work.sum());
  to.potential.add(packs.potential.sum());
}

/// Energies booked for good, and the start of the ledger  [J; in 2D J/m].
struct Ledger {
  ExactSum friction, contact;  ///< of contacts that were dropped at a search
  ExactSum came_in;            ///< work of them; stored in joints when they were inserted
  ExactSum start_potential;    ///< sum of m g.x at the start
  double start = 0.0;          ///< kinetic and elastic energy at the start
  double largest = 0.0;        ///< largest sum of energies and work seen

  /// Books the energies that dropped contacts have spent.
  void book(const Energies& spent) {
    friction.add(spent.friction);
    contact.add(spent.contact);
    came_in.add(spent.work);
  }
  /// Adds the bookings of another part of the model.
  void add(const Ledger& booked) {
    friction.add(booked.friction);
    contact.add(booked.contact);
    came_in.add(booked.came_in);
  }
};

/// Where the energy of a model is at one moment, and what went in and out since the start  [J].
struct EnergyBalance {
  double kinetic = 0.0;           ///< of translation and rotation
  double elastic = 0.0;           ///< stored in links and contacts
  double fracture = 0.0;          ///< spent on softening and breaking
  double plastic = 0.0;           ///< spent on yielding of steel and on plastic moments
  double friction = 0.0;          ///< spent on sliding
  double damping = 0.0;           ///< taken by local damping
  double contact = 0.0;           ///< taken by the dashpots of contacts
  double work = 0.0;              ///< put in by gravity, walls and prescribed motion
  double start = 0.0;             ///< kinetic and elastic at the start
  double error_relative = 0.0;    ///< |what is missing| / the largest energy there was  [-]
  double contact_relative = 0.0;  ///< |contact| / the largest energy there was  [-]

  double total() const {
    return kinetic + elastic + fracture + plastic + friction + damping + contact;
  }
  double missing() const { return total() - start - work; }
  /// Sets the two shares. @param largest  energy that there was  [J; in 2D J/m]
  void relate_to(double largest) {
    if (!(largest > 0.0)) return;
    error_relative = std::fabs(missing()) / largest;
    contact_relative = std::fabs(contact) / largest;
  }
};

}  // namespace breccia
