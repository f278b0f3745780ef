#pragma once
// Cylinders with a nose: where their surface is nearest to a point, in a half plane through the
// axis.

#include "math/vec.hpp"

namespace breccia::dem {

/// Place and normal in a half plane through the axis of a body of revolution.
struct NearestOutline {
  double behind;   ///< of the unit normal out of the body: away from the tip, along the axis  [-]
  double outward;  ///< of it: away from the axis  [-]
  double height;   ///< of the point above the surface; below 0: inside  [m]
};

namespace nose_detail {

/// From an edge or the tip, given the way from there to a point.
BR_HD inline NearestOutline from_edge(double behind, double outward) {
  const double height = sqrt(behind * behind + outward * outward);
  return {behind / height, outward / height, height};
}

/// The flank of the cylinder as if it went on for ever.
BR_HD inline NearestOutline flank(double off, double radius) {
  return {0.0, 1.0, off - radius};
}

/// A cone and the flank behind it.
BR_HD inline NearestOutline of_cone(double behind, double off, double radius, double nose) {
  const double slant = sqrt(nose * nose + radius * radius);
  const double cosine = nose / slant, sine = radius / slant;
  const double along = behind * cosine + off * sine, above = off * cosine - behind * sine;
  const double beside = off - radius;
  if (along < 0.0) return from_edge(behind, off);
  if (behind >= nose && (beside >= 0.0 || beside >= above)) return flank(off, radius);
  if (behind < nose && along > slant) return from_edge(behind - nose, beside);
  if (above >= 0.0 || above >= beside) return {-sine, cosine, above};
  return flank(off, radius);
}

/// An arc that meets the flank without a bend. Its centre lies off the axis, on the other side of
/// it, by `beyond`; a hemisphere's lies on the axis.
BR_HD inline NearestOutline of_ogive(double behind, double off, double radius, double nose) {
  if (behind >= nose) return flank(off, radius);
  const double arc = (radius * radius + nose * nose) / (2.0 * radius), beyond = arc - radius;
  if ((nose - behind) * beyond > nose * (off + beyond)) return from_edge(behind, off);
  const double back = behind - nose, out = off + beyond, way = sqrt(back * back + out * out);
  return {back / way, out / way, way - arc};
}

}  // namespace nose_detail

/// The outline of a cylinder with a nose, nearest to a point.
/// @param behind   how far the point lies behind the tip, along the axis  [m]
/// @param off      its distance from the axis  [m], >= 0
/// @param length   of the body with its nose  [m]
/// @param nose     its length  [m]
/// @param is_cone  otherwise an ogive
BR_HD inline NearestOutline nearest_outline(double behind, double off, double radius, double length,
                                            double nose, bool is_cone) {
  const double past = behind - length, beside = off - radius;
  if (past > 0.0)
    return beside > 0.0 ? nose_detail::from_edge(past, beside) : NearestOutline{1.0, 0.0, past};
  const NearestOutline front = is_cone ? nose_detail::of_cone(behind, off, radius, nose)
                                       : nose_detail::of_ogive(behind, off, radius, nose);
  return front.height >= 0.0 || front.height >= past ? front : NearestOutline{1.0, 0.0, past};
}

}  // namespace breccia::dem
