#pragma once
// Sieve curves: how many spheres of which size a mass of them holds.

#include <string>
#include <vector>

namespace breccia::prepare {

/// A grading curve: the share of the mass that passes each sieve, linear in the size in between.
///
///   numbers between sieves d_1 and d_2 that pass p_1 and p_2:  dn/dd ~ (p_2 - p_1)/(d_2 - d_1)
///   d^-3
///
/// Only + - * / sqrt: the same bits on any machine.
struct Grading {
  std::vector<double> sieves{};   ///< ascending, > 0  [m]
  std::vector<double> passing{};  ///< share of the mass, from 0 to 1, never falling  [-]

  bool empty() const { return sieves.empty(); }
  /// The first error of the curve, to stand after the name of its table; empty: none.
  std::string problem() const;
  /// Share of the mass in diameters below one. It has no problem, as for all below.  [-]
  double passes(double diameter) const;
  /// The curve of what lies between two diameters, a curve of its own.
  Grading part(double from, double to) const;
  /// Mean volume of its spheres by number.  [m3]
  double mean_volume() const;
  /// Diameter below which this share of the number lies.  [m]
  double diameter_at(double share) const;

 private:
  /// Spheres between sieve k and the next in a solid volume of one, times pi/3.  [1/m3]
  double number(std::size_t k) const;
};

}  // namespace breccia::prepare
