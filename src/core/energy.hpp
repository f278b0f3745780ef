#pragma once
// The ledger: where every joule is. Sums are exact, so their order cannot matter.

#include <cmath>
#include <cstdint>

#include "exec/types.hpp"

namespace breccia {

/// A sum of doubles in fixed point, 128 bit with a quantum of 2^-64: each term is rounded once, by
/// itself, so the sum is the same for any order, thread count, rank count and device.
/// Holds |sum| < 2^63 of the unit, to 5e-20. A term that is beyond that, or no number, makes the
/// sum infinite for good, in whatever order it comes.
class ExactSum {
  __extension__ using Quanta = unsigned __int128;
  static constexpr Quanta overflown = static_cast<Quanta>(1) << 127;
  static constexpr double limit = 9223372036854775808.0;  // 2^63

 public:
  ExactSum() = default;
  BR_HD explicit ExactSum(double value) { add(value); }

  BR_HD void add(double value) {
    if (value == 0.0) return;  // most of what most items have spent
    const double scaled_high = value < 0.0 ? -value : value;
    if (!(scaled_high < limit) || quanta_ == overflown) {
      quanta_ = overflown;
      return;
    }
    const double whole = static_cast<double>(static_cast<std::int64_t>(scaled_high));
    const double fraction = (scaled_high - whole) * 18446744073709551616.0;  // 2^64
    Quanta quanta = static_cast<Quanta>(static_cast<std::uint64_t>(whole)) << 64;
    quanta += static_cast<std::uint64_t>(fraction);
    if (value < 0.0)
      quanta_ -= quanta;
    else
      quanta_ += quanta;
  }
  BR_HD void add(const ExactSum& other) {
    const bool lost = quanta_ == overflown || other.quanta_ == overflown;
    quanta_ = lost ? overflown : quanta_ + other.quanta_;
  }

  BR_HD double value() const {
    if (quanta_ == overflown) return INFINITY;
    const bool negative = (quanta_ >> 127) != 0;
    const Quanta size = negative ? -quanta_ : quanta_;
    const double high = static_cast<double>(static_cast<std::uint64_t>(size >> 64));
    const double low = static_cast<double>(static_cast<std::uint64_t>(size));
    const double result = high + low / 18446744073709551616.0;
    return negative ? -result : result;
  }

 private:
  Quanta quanta_ = 0;
};

BR_HD inline ExactSum operator+(ExactSum a, const ExactSum& b) {
  a.add(b);
  return a;
}

/// Energies of items, of a part or of all of a model, by the columns of the ledger  [J; in 2D J/m].
struct Energies {
  ExactSum kinetic, elastic;
  ExactSum fracture;  ///< where modes are told apart: by opening
  ExactSum sliding;   ///< fracture by sliding
  ExactSum plastic, friction, damping, contact, work;
  ExactSum potential;  ///< sum of m g.x: gravity has done work where it falls
};
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
