#pragma once
// Least and largest components of places, for bounds of what they make up.

#include <algorithm>
#include <array>

#include "math/vec.hpp"

namespace breccia {

using Place = std::array<double, 3>;  ///< in an order, for maps

inline Place place_of(const Vec3& v) {
  return {v.x, v.y, v.z};
}
inline Vec3 least_of(const Vec3& a, const Vec3& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline Vec3 most_of(const Vec3& a, const Vec3& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

}  // namespace breccia
