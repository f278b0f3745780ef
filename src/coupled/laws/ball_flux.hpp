#pragma once
// A rigid sphere that presses on flat triangles, by the flux of its potential
// (docs/theory-coupled.md, 1).

#include "math/constants.hpp"
#include "math/elementary.hpp"
#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia::coupled {

/// Push of a sphere with the potential phi = (R^2 - r^2)/(2R), r from its centre c, on the part of
/// a triangle that is inside it, per penalty.
struct BallFlux {
  Vec3 normal;      ///< n, unit, out of the body  [-]
  double push;      ///< integral of phi over that part  [m3]
  double share[3];  ///< of phi times the share of each corner; their sum is `push`  [m3]
  Vec3 lever;       ///< of phi times x - c, along the triangle  [m4]
  double area;      ///< of that part  [m2]
};

namespace detail {

/// The angle from p to q in (-pi, pi), with the same bits everywhere.
BR_HD inline double angle_from(const Vec2& p, const Vec2& q) {
  const double y = cross(p, q), x = dot(p, q);
  const double high = abs(y), wide = abs(x);
  double angle = high <= wide ? arc_tangent(high / wide) : 0.5 * pi - arc_tangent(wide / high);
  if (x < 0.0) angle = pi - angle;
  return y < 0.0 ? -angle : angle;
}

/// Integrals over the part of a polygon that is in the disc of radius a around the origin, edge by
/// edge: what lies between the edge and the origin, with its sign.
struct DiscIntegrals {
  double square;        ///< a^2  [m2]
  double zeroth = 0.0;  ///< of a^2 - rho^2  [m4]
  Vec2 first{};         ///< of (a^2 - rho^2) rho  [m5]
  double area = 0.0;    ///< [m2]
  bool cuts = false;    ///< some edge has a part in the disc

  BR_HD void add_inside(const Vec2& p, const Vec2& q) {
    const double a = 0.5 * cross(p, q), pp = dot(p, p), pq = dot(p, q), qq = dot(q, q);
    zeroth += square * a - a / 6.0 * (pp + pq + qq);
    const double third = square * a / 3.0, part = a / 30.0;
    first += (third - part * (3.0 * pp + 2.0 * pq + qq)) * p +
             (third - part * (pp + 2.0 * pq + 3.0 * qq)) * q;
    area += a;
    cuts = true;
  }
  BR_HD void add_outside(const Vec2& p, const Vec2& q) {
    const double angle = angle_from(p, q), root = sqrt(square);
    const Vec2 u = (1.0 / norm(p)) * p, w = (1.0 / norm(q)) * q;
    zeroth += 0.25 * square * square * angle;
    first += (2.0 / 15.0 * square * square * root) * Vec2{w.y - u.y, u.x - w.x};
    area += 0.5 * square * angle;
  }
  BR_HD void add_edge(const Vec2& p, const Vec2& q) {
    const Vec2 way = q - p;
    const double a = dot(way, way), half = dot(p, way), c = dot(p, p) - square;
    const double root_of = half * half - a * c;
    if (!(root_of > 0.0)) return add_outside(p, q);
    const double root = sqrt(root_of);
    const double enters = max(0.0, (-half - root) / a), leaves = min(1.0, (-half + root) / a);
    if (!(enters < leaves)) return add_outside(p, q);
    const Vec2 in = enters > 0.0 ? p + enters * way : p;
    const Vec2 out = leaves < 1.0 ? p + leaves * way : q;
    if (enters > 0.0) add_outside(p, in);
    add_inside(in, out);
    if (leaves < 1.0) add_outside(out, q);
  }
};

}  // namespace detail

/// The flux through a triangle whose corners run counter-clockwise seen from outside.
/// @returns false where nothing of it is inside the sphere
BR_HD inline bool flux_of_face(const Vec3& centre, double radius, const Vec3 (&x)[3],
                               BallFlux& flux) {
  const Vec3 side = x[1] - x[0];
  const Vec3 twice = cross(side, x[2] - x[0]);
  const double size = norm(twice), length = norm(side);
  if (!(size > 0.0)) return false;
  const Vec3 n = (1.0 / size) * twice, e = (1.0 / length) * side, f = cross(n, e);
  const double depth = dot(centre - x[0], n), square = radius * radius - depth * depth;
  if (!(square > 0.0)) return false;
  Vec2 p[3];  // corners as seen from the foot of the centre on the plane
  for (int k = 0; k < 3; ++k) {
    const Vec3 to = x[k] - centre;
    p[k] = {dot(to, e), dot(to, f)};
  }
  double share[3];  // of the corners at the foot
  bool above = true;
  for (int k = 0; k < 3; ++k) {
    const Vec2 &from = p[(k + 1) % 3], &to = p[(k + 2) % 3];
    const double turn = cross(from, to);
    const Vec2 edge = to - from;
    if (turn < 0.0 && turn * turn >= square * dot(edge, edge)) return false;  // disc beyond an edge
    above = above && turn >= 0.0;
    share[k] = turn / size;
  }
  detail::DiscIntegrals in{square};
  for (int k = 0; k < 3; ++k) in.add_edge(p[k], p[(k + 1) % 3]);
  if (!in.cuts) {
    if (!above) return false;  // beyond a corner
    in.zeroth = 0.5 * pi * square * square;
    in.first = {};
    in.area = pi * square;
  }
  const double half = 0.5 / radius;
  flux.normal = n;
  flux.push = half * in.zeroth;
  if (!(flux.push > 0.0)) return false;
  for (int k = 0; k < 2; ++k) {
    const Vec2 edge = p[(k + 2) % 3] - p[(k + 1) % 3];
    const double slope = (in.first.y * edge.x - in.first.x * edge.y) / size;
    flux.share[k] = half * (share[k] * in.zeroth + slope);
  }
  flux.share[2] = flux.push - flux.share[0] - flux.share[1];
  flux.lever = half * (in.first.x * e + in.first.y * f);
  flux.area = in.area;
  return true;
}

}  // namespace breccia::coupled
