#pragma once
// The shortest way between two segments.

#include <algorithm>

#include "math/vec.hpp"

namespace breccia::prepare {

struct NearestOfSegments {
  double distance;  ///<  [m]
  Vec3 at;          ///< on the first one  [m]
};

/// Between the segments from a to b and from c to d; either may be a point.
inline NearestOfSegments nearest_of_segments(const Vec3& a, const Vec3& b, const Vec3& c,
                                             const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double across = uu * vv - uv * uv;
  double s = across > 1e-12 * uu * vv ? std::clamp((uv * vw - vv * uw) / across, 0.0, 1.0) : 0.0;
  const double t = vv > 0.0 ? std::clamp((uv * s + vw) / vv, 0.0, 1.0) : 0.0;
  s = uu > 0.0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0.0;
  const Vec3 at = a + s * u;
  return {norm(at - (c + t * v)), at};
}

}  // namespace breccia::prepare
