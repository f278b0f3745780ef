#pragma once
// Stress in situ that joints or weight do not bear.

#include <algorithm>
#include <cstdio>
#include <string>
#include <type_traits>
#include <vector>

#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Of two or three coordinates, without brackets.
inline std::string numbers_of(const Vec2& v) {
  char text[64];
  std::snprintf(text, sizeof text, "%.6g, %.6g", v.x + 0.0, v.y + 0.0);  // no -0
  return text;
}
inline std::string numbers_of(const Vec3& v) {
  char text[96];
  std::snprintf(text, sizeof text, "%.6g, %.6g, %.6g", v.x + 0.0, v.y + 0.0, v.z + 0.0);
  return text;
}

/// The error that a joint cannot hold the stress at the start.
/// @param elements       "triangles 3 and 9"  @param middle  of the joint  [m]
/// @param normal, shear  its traction, pulled above 0, and size along it  [Pa]
/// @param tension        what it bears across  [Pa]
template <class Vector>
std::string too_weak_for_stress(const std::string& elements, const Vector& middle, double normal,
                                double shear, double tension) {
  char how[200];
  if (normal > 0.99 * tension)
    std::snprintf(how, sizeof how,
                  "it is pulled with %.4g Pa and bears %.4g Pa (tension is positive: rock under "
                  "pressure has negative xx, yy%s)",
                  normal, tension, std::is_same_v<Vector, Vec3> ? ", zz" : "");
  else
    std::snprintf(how, sizeof how, "%.4g Pa shear it under %.4g Pa of pressure", shear,
                  -normal + 0.0);
  return "in_situ: the joint between " + elements + " at (" + numbers_of(middle) +
         ") m is too weak for this stress: " + how;
}

/// Stress in situ with a slope, or gravity without one, by which rock moves at once. Forces per
/// volume that are missing are held against the weight.
/// @param sums  what the slopes add up to along x, y (and z)
template <class Config>
void look_for_unbalanced_weight(const Config& config, const char* sums,
                                std::vector<std::string>& found) {
  if (!config.in_situ.any()) return;
  const auto push = config.in_situ.push();
  for (const auto& m : config.materials) {
    const auto weight = m.density * config.gravity.at(0.0), rest = push + weight;
    if (norm(rest) <= 0.01 * std::max(norm(push), norm(weight))) continue;
    found.push_back("in_situ is not in equilibrium with gravity: its slopes push " + m.name +
                    " with (" + numbers_of(push) + ") N/m3, its weight is (" + numbers_of(weight) +
                    ") N/m3; where " + sums + " are " + numbers_of(-weight) +
                    " Pa/m nothing moves at the start");
    return;
  }
}

}  // namespace breccia::fdem_shared
