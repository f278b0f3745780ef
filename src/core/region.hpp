#pragma once
// Forms of regions besides a box: circles, cylinders, spheres, polygons, and all that lies
// outside.

#include <string>
#include <vector>

#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia {

/// Whether a point lies in a polygon, whose sides do not cross; points on a side count as inside on
/// some sides only.
inline bool in_polygon(const std::vector<Vec2>& corners, const Vec2& x) {
  bool inside = false;
  for (std::size_t k = 0, last = corners.size() - 1; k < corners.size(); last = k++) {
    const Vec2 &a = corners[k], &b = corners[last];
    if ((a.y > x.y) == (b.y > x.y)) continue;
    if (x.x < a.x + (x.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

/// Whether a point lies in a circle or on it, to rounding.
inline bool in_circle(const Vec2& center, double radius, const Vec2& x) {
  return dot(x - center, x - center) <= radius * radius * (1.0 + 1e-9);
}

/// Whether a point lies in a cylinder around an axis through a point, or, without an axis, in a
/// sphere.
/// @param around  x, y, z, or empty
inline bool in_round(const Vec3& center, double radius, const std::string& around, const Vec3& x) {
  Vec3 away = x - center;
  if (around == "x") away.x = 0.0;
  if (around == "y") away.y = 0.0;
  if (around == "z") away.z = 0.0;
  return dot(away, away) <= radius * radius * (1.0 + 1e-9);
}

/// A point as seen along an axis, in the plane of the two that follow it: (y, z), (z, x) or (x, y).
/// @param axis  x, y, or else z
inline Vec2 seen_along(const std::string& axis, const Vec3& x) {
  return axis == "x" ? Vec2{x.y, x.z} : axis == "y" ? Vec2{x.z, x.x} : Vec2{x.x, x.y};
}

}  // namespace breccia
