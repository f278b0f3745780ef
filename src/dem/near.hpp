#pragma once
// Which pairs of spheres may touch until the next search.

#include "dem/elements.hpp"

namespace breccia::dem {

/// An element as a search sees it.
struct NearSphere {
  Vec3 position;          ///<  [m]
  double radius, margin;  ///<  [m]
};

/// Whether two grown spheres overlap, not only their boxes.
/// @param a  that with the lower global id
/// @param rounding  of the drift's way  [m]
BR_HD inline bool may_touch(const NearSphere& a, const NearSphere& b, double rounding) {
  const Vec3 d = b.position - a.position;
  const double reach = (a.radius + b.radius + a.margin + b.margin) * (1.0 + 1e-12) + rounding;
  return !(dot(d, d) > reach * reach);
}

/// Steps for which a fast element's margin shall last.
inline constexpr double margin_horizon = 50.0;

}  // namespace breccia::dem
