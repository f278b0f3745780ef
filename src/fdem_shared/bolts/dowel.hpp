#pragma once
// Shear action of a bar across a joint (dowel action). It knows no elements.

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia::fdem_shared {

/// The part of a way across a bar: one number in the plane, two in space.
template <class Vector>
using AcrossOf = std::conditional_t<std::is_same_v<Vector, Vec2>, double, Vec2>;

inline double times(double a, double b) {
  return a * b;
}
inline double times(const Vec2& a, const Vec2& b) {
  return dot(a, b);
}
/// One number for people: in the plane with its sign, in space the size.
inline double as_one(double across) {
  return across;
}
inline double as_one(const Vec2& across) {
  return norm(across);
}

/// Directions that the rock at one end of a piece of a bar carries with it: the way along the bar,
/// in space also one across it, which tells the two ways of an offset apart.
template <class Vector>
struct CarriedOf;
template <>
struct CarriedOf<Vec2> {
  Vec2 along{};
};
template <>
struct CarriedOf<Vec3> {
  Vec3 along{}, side{};
};

/// How far the two ends of a piece of a bar lie out of line. With the way d between its ends and
/// the directions t_a, t_b in which the rock at each end has carried it,
///
///   w = m x d,   m = (t_a + t_b)/|t_a + t_b|
///
/// which is zero of any turn and of any even strain: of slip of a joint alone, and half as much of
/// what bends. The bar pushes one end with -Q n, the other with Q n, n across m, and turns the rock
/// at each of them, which carries t with it: no sum, no moment.
struct PlaneOffset {
  Vec2 across{};       ///< n  [-]
  double way = 0.0;    ///< w  [m]
  double lever = 0.0;  ///< d m/|t_a + t_b|: of forces that turn, over Q, times corners' parts in t

  static PlaneOffset of(const Vec2& d, const Vec2& at_a, const Vec2& at_b) {
    const Vec2 sum = at_a + at_b;
    const double size = norm(sum);
    const Vec2 m = (1.0 / size) * sum;
    return {{-m.y, m.x}, cross(m, d), dot(d, m) / size};
  }
  static PlaneOffset of(const Vec2& d, const CarriedOf<Vec2>& a, const CarriedOf<Vec2>& b) {
    return of(d, a.along, b.along);
  }
  Vec2 push(double force) const { return force * across; }
  /// Calls visit(size, parts, direction) for the forces that turn the rock at an end: size times
  /// the parts of what it carries, on corners.
  /// @param parts  of it along edges
  template <class Visit>
  void each_turn(double force, const CarriedOf<Vec2>& parts, const Visit& visit) const {
    visit(lever, parts.along, push(force));
  }
};

/// In space w has two parts, along e and f across m,
///
///   w = (e d, f d),   e = (1 - m m) (c_a + c_b)/|...|,   f = m x e
///
/// with a direction c across the bar that the rock at each end carries, too. They turn with the
/// rock, so that the part of an offset that stays turns with it. The forces are the slopes of an
/// energy of w alone: with Q = Q_e e + Q_f f, Q and -Q at the ends, (d m)/|t_a + t_b| Q by parts in
/// t, and where Q and w are not parallel, as after yield in another direction,
///
///   s ((c_a + c_b) m)/|t_a + t_b| f by parts in t,   -s f by parts in c,
///   s = (Q_e w_f - Q_f w_e)/|(1 - m m) (c_a + c_b)|
///
/// whose moment about m is that of Q and w.
struct SpaceOffset {
  Vec3 e{}, f{};         ///< [-]
  Vec2 way{};            ///< w  [m]
  double lever = 0.0;    ///< as in the plane
  double twist = 0.0;    ///< 1/|(1 - m m) (c_a + c_b)|  [-]
  double leaning = 0.0;  ///< ((c_a + c_b) m)/|t_a + t_b|  [1/m]

  static SpaceOffset of(const Vec3& d, const CarriedOf<Vec3>& a, const CarriedOf<Vec3>& b) {
    const Vec3 sum = a.along + b.along, sides = a.side + b.side;
    const double size = norm(sum);
    const Vec3 m = (1.0 / size) * sum;
    const double leans = dot(sides, m);
    const Vec3 across = sides - leans * m;
    SpaceOffset o;
    o.twist = 1.0 / norm(across);
    o.e = o.twist * across;
    o.f = cross(m, o.e);
    o.way = {dot(o.e, d), dot(o.f, d)};
    o.lever = dot(d, m) / size;
    o.leaning = leans / size;
    return o;
  }
  Vec3 push(const Vec2& force) const { return force.x * e + force.y * f; }
  template <class Visit>
  void each_turn(const Vec2& force, const CarriedOf<Vec3>& parts, const Visit& visit) const {
    visit(lever, parts.along, push(force));
    const double moment = cross(force, way);
    if (moment == 0.0) return;
    visit(moment * twist * leaning, parts.along, f);
    visit(-moment * twist, parts.side, f);
  }
};

template <class Vector>
using OffsetOf = std::conditional_t<std::is_same_v<Vector, Vec2>, PlaneOffset, SpaceOffset>;

/// Q = K (w - p), |Q| <= Q_y; offset beyond goes into p. In space w, p and Q have two parts, and a
/// round bar and its grout are alike in all directions: |Q| is their length, and p grows along Q.
///
/// A bar of bending stiffness E I in grout that resists its way across with k per length bends on
/// both sides of a joint as a beam on an elastic foundation: Q = E I beta^3 w, beta = (k/(4 E
/// I))^(1/4) (Friberg 1940). It bears at most 1.27 d^2 sqrt(f_c f_y), when the bar yields in
/// bending and the grout is crushed (He and Kwan 2001; Rasmussen 1963 found 1.3).
struct Dowel {
  double stiffness = 0.0;  ///< K, 0: none  [N/m; in 2D N/m2]
  double strength = 0.0;   ///< Q_y  [N; in 2D N/m]

  double force(double offset, double kept) const {
    return std::clamp(stiffness * (offset - kept), -strength, strength);
  }
  Vec2 force(const Vec2& offset, const Vec2& kept) const {
    const Vec2 elastic = stiffness * (offset - kept);
    const double size = norm(elastic);
    return size > strength ? (strength / size) * elastic : elastic;
  }
  /// The part of an offset beyond the force, which stays.  [m]
  double beyond(double offset, double kept, double force) const {
    return offset - kept - force / stiffness;
  }
  Vec2 beyond(const Vec2& offset, const Vec2& kept, const Vec2& force) const {
    const Vec2 elastic = stiffness * (offset - kept);
    if (norm(elastic) <= strength) return {};
    return offset - kept - (1.0 / stiffness) * force;
  }
  /// Elastic energy.  [J; in 2D J/m]
  double stored(double force) const { return 0.5 * force * force / stiffness; }
};

}  // namespace breccia::fdem_shared
