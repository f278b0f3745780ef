#pragma once
// The gas of an explosive that has detonated.

#include "math/elementary.hpp"

namespace breccia::fdem_shared {

/// Adiabatic expansion of the products by the equation of Jones, Wilkins and Lee (Lee, Hornig and
/// Kury 1968, UCRL-50422), V their volume over that of the explosive:
///
///   p = A e^(-R_1 V) + B e^(-R_2 V) + C V^-(1 + omega)
///   E = A/R_1 e^(-R_1 V) + B/R_2 e^(-R_2 V) + C/omega V^-omega,   p = -dE/dV
///
/// C such that E(1) = E_0: all of it has burnt at constant volume, without loss. Gas that has run
/// into empty room without work has more energy than that, and another C: pressure follows from
/// both, p = A e^(-R_1 V) + B e^(-R_2 V) + omega (E - E_c)/V with the cold part E_c, the first two
/// terms of E.
struct ExplosiveGas {
  double a = 0.0, b = 0.0;                 ///<  [Pa]
  double r1 = 1.0, r2 = 1.0, omega = 1.0;  ///<  [-]
  double c = 0.0;                          ///<  [Pa]

  /// @param energy  E_0, per volume of explosive  [J/m3]
  static ExplosiveGas of(double a, double b, double r1, double r2, double omega, double energy) {
    return {a,  b,     r1,
            r2, omega, omega * (energy - a / r1 * exponential(-r1) - b / r2 * exponential(-r2))};
  }
  double pressure(double volume) const {
    return a * exponential(-r1 * volume) + b * exponential(-r2 * volume) +
           c * power(volume, -(1.0 + omega));
  }
  /// Energy that expansion without limit would still set free.  [J/m3]
  double energy(double volume) const { return cold(volume) + c / omega * power(volume, -omega); }
  /// Of gas with this energy.  [Pa]
  double pressure(double volume, double energy) const {
    return a * exponential(-r1 * volume) + b * exponential(-r2 * volume) +
           omega * (energy - cold(volume)) / volume;
  }

 private:
  double cold(double volume) const {
    return a / r1 * exponential(-r1 * volume) + b / r2 * exponential(-r2 * volume);
  }
  static double power(double volume, double exponent) {
    return exponential(exponent * logarithm(volume));
  }
};

}  // namespace breccia::fdem_shared
