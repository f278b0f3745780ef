#pragma once
// The energy below which nothing tells a model from one at rest.

#include <algorithm>
#include <vector>

#include "core/exact_sum.hpp"
#include "exec/buffer.hpp"
#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia {

/// The energy that rounding may give a model in one step,
///
///   M/2 (2^-52 |x|_max / dt)^2,
///
/// M the mass of all. A step rounds a coordinate by at most 2^-53 |x|, which its neighbours feel as
/// if it had moved at that over dt. Such kicks do not know of each other, so that their energies
/// add up: those of n steps are n times as much. (A plate at rest gets 0.004 of it.) Masses are
/// summed exactly and the step is that of set-up: every device and any ranks find one number.
/// @returns energy  [J; in 2D J/m]
/// @param mass   of all elements or corners  [kg; in 2D kg/m]
/// @param point  of the model as it is built  [m]
/// @param step   the first one  [s]
template <class Points>
double energy_of_rounding(const Buffer<double>& mass, const Points& point, double step) {
  if (!(step > 0.0)) return 0.0;
  std::vector<double> own;
  copy_to(own, mass);
  ExactSum all;
  for (const double m : own) all.add(m);
  double farthest = 0.0;
  for (const auto& x : point) farthest = std::max(farthest, norm(x));
  const double speed = 0x1p-52 * farthest / step;
  return 0.5 * all.value() * speed * speed;
}

}  // namespace breccia
