#pragma once
// The box of a sphere in a search.

#include "core/broad_phase.hpp"

namespace breccia {

/// Box of a sphere, grown by its margin and by a few roundings of the coordinates, so that the
/// claim of core/travel.hpp holds in floating-point numbers, too.
/// @param radius    reach of the element: two touch within the sum of theirs  [m]
/// @param farthest  way of the drift whose rounding is covered, too  [m]
BR_HD inline Box grown_box(const Vec3& centre, double radius, double margin, double farthest) {
  // 32 times the rounding of one operation: the sums here, the test of the travel and the test
  // of the contact round about 12 times together.
  constexpr double rounding = 1.0 / 281474976710656.0;  // 2^-48
  const double reach = radius + margin + rounding * farthest;
  const Vec3 half{reach + rounding * (reach + abs(centre.x)),
                  reach + rounding * (reach + abs(centre.y)),
                  reach + rounding * (reach + abs(centre.z))};
  return {centre - half, centre + half};
}

}  // namespace breccia
