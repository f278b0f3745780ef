#pragma once
// Contact of two triangles by the potential of Munjiza and Andrews (2000).

#include "math/vec2.hpp"

namespace breccia::fdem {

/// A triangle seen by the points of another: where a point lies in it.
struct Target {
  Vec2 x[3];           ///< corners, counter-clockwise  [m]
  double over_double;  ///< 1 / (2 area)  [1/m2]

  BR_HD static Target of(const Vec2 (&corner)[3]) {
    return {{corner[0], corner[1], corner[2]},
            1.0 / cross(corner[1] - corner[0], corner[2] - corner[0])};
  }
  /// Area coordinates of a point; they sum to 1.
  BR_HD void coordinates(const Vec2& p, double (&l)[3]) const {
    l[1] = over_double * cross(p - x[0], x[2] - x[0]);
    l[2] = over_double * cross(x[1] - x[0], p - x[0]);
    l[0] = over_double * cross(x[2] - x[1], p - x[1]);
  }
  /// Gradient of area coordinate k.  [1/m]
  BR_HD Vec2 slope(int k) const {
    const Vec2 edge = x[(k + 2) % 3] - x[(k + 1) % 3];
    return over_double * Vec2{-edge.y, edge.x};
  }
};

/// Whether a line along an edge of the target has all these corners clearly outside: no edge of
/// either overlaps the other then, however numbers round.
BR_HD inline bool outside(const Vec2 (&corner)[3], const Target& target) {
  constexpr double clearly = -1e-9;
  double l[3][3];
  for (int k = 0; k < 3; ++k) target.coordinates(corner[k], l[k]);
  bool beyond = false;
  for (int k = 0; k < 3; ++k)
    beyond = beyond || (l[0][k] < clearly && l[1][k] < clearly && l[2][k] < clearly);
  return beyond;
}

/// What an edge meets inside another triangle, with the potential phi = 3 min(l0, l1, l2): 0 on the
/// border, 1 in the middle.
struct EdgeOverlap {
  double whole = 0.0;             ///< integral of phi over s, the share of the edge  [-]
  double moment = 0.0;            ///< integral of phi s over s  [-]
  double begin = 0.0, end = 0.0;  ///< the part of the edge that lies inside, in s  [-]
  double at_a[3], at_b[3];        ///< area coordinates of the edge's ends in the target  [-]
};

/// The edge a -> b through a target. False if no part of it lies inside. Exact: phi is linear
/// between the breaks where two area coordinates are least together (Munjiza 2004, 2.50-2.56).
BR_HD inline bool overlap_of_edge(const Vec2& a, const Vec2& b, const Target& target,
                                  EdgeOverlap& o) {
  target.coordinates(a, o.at_a);
  target.coordinates(b, o.at_b);
  o.begin = 0.0;
  o.end = 1.0;
  for (int k = 0; k < 3; ++k) {
    const double la = o.at_a[k], lb = o.at_b[k];
    if (la <= 0.0 && lb <= 0.0) return false;
    if (la < 0.0) o.begin = max(o.begin, la / (la - lb));
    if (lb < 0.0) o.end = min(o.end, la / (la - lb));
  }
  if (!(o.end > o.begin)) return false;

  // Breaks, ascending; where there are fewer than three, the end again.
  double s[5] = {o.begin, o.end, o.end, o.end, o.end};
  for (int k = 0; k < 3; ++k) {
    const int m = (k + 1) % 3, other = (k + 2) % 3;
    const double difference_a = o.at_a[k] - o.at_a[m], difference_b = o.at_b[k] - o.at_b[m];
    const double change = difference_a - difference_b;
    if (change == 0.0) continue;
    double at = difference_a / change;
    if (!(at > o.begin && at < o.end)) continue;
    const double least = o.at_a[k] + at * (o.at_b[k] - o.at_a[k]);
    if (least > o.at_a[other] + at * (o.at_b[other] - o.at_a[other])) continue;
    for (int i = 1; i < 4; ++i) {  // an index that is not known in advance costs GPUs much
      const double here = min(s[i], at);
      at = max(s[i], at);
      s[i] = here;
    }
  }

  const auto phi = [&o](double at) {
    double least = 1.0;
    for (int k = 0; k < 3; ++k) least = min(least, o.at_a[k] + at * (o.at_b[k] - o.at_a[k]));
    return 3.0 * max(0.0, least);
  };
  o.whole = 0.0;
  o.moment = 0.0;
  double before = phi(s[0]);
  for (int i = 0; i < 4; ++i) {
    const double after = phi(s[i + 1]), width = s[i + 1] - s[i];
    o.whole += 0.5 * width * (before + after);
    o.moment +=
        (1.0 / 6.0) * width * (before * (2.0 * s[i] + s[i + 1]) + after * (s[i] + 2.0 * s[i + 1]));
    before = after;
  }
  return o.whole > 0.0;
}

/// Adds a force on an edge's ends and its reaction on the target's corners: force and moment of the
/// two triangles together are zero.
BR_HD inline void push(const EdgeOverlap& o, int edge, const Vec2& on_a, const Vec2& on_b,
                       Vec2 (&contactor)[3], Vec2 (&target)[3]) {
  contactor[edge] += on_a;
  contactor[(edge + 1) % 3] += on_b;
  for (int k = 0; k < 3; ++k) target[k] -= o.at_a[k] * on_a + o.at_b[k] * on_b;
}

/// Force of an overlap on the edge's ends: -p phi n ds, shared by linear shape functions.
/// @param penalty  p  [Pa]
BR_HD inline void normal_forces(const EdgeOverlap& o, const Vec2& a, const Vec2& b, double penalty,
                                Vec2& on_a, Vec2& on_b) {
  const Vec2 outward{penalty * (b.y - a.y), penalty * (a.x - b.x)};  // times the edge's length
  on_b = -o.moment * outward;
  on_a = -(o.whole - o.moment) * outward;
}

/// A convex polygon of at most eight corners.
struct Polygon {
  Vec2 corner[8];
  int count = 0;
};

/// Cuts away what lies where weight . coordinates < 0, a linear function given at each corner by
/// `side`.
template <class Side>
BR_HD Polygon cut(const Polygon& p, const Side& side) {
  Polygon kept;
  for (int i = 0; i < p.count; ++i) {
    const Vec2 &from = p.corner[i], &to = p.corner[(i + 1) % p.count];
    const double at_from = side(from), at_to = side(to);
    if (at_from >= 0.0 && kept.count < 8) kept.corner[kept.count++] = from;
    if ((at_from >= 0.0) != (at_to >= 0.0) && kept.count < 8) {
      const double share = at_from / (at_from - at_to);
      kept.corner[kept.count++] = from + share * (to - from);
    }
  }
  return kept;
}

/// Integral of a function that is linear over a polygon.
template <class Function>
BR_HD double integral(const Polygon& p, const Function& f) {
  double sum = 0.0;
  for (int i = 1; i + 1 < p.count; ++i) {
    const double area = 0.5 * cross(p.corner[i] - p.corner[0], p.corner[i + 1] - p.corner[0]);
    sum += area * (f(p.corner[0]) + f(p.corner[i]) + f(p.corner[i + 1])) / 3.0;
  }
  return sum;
}

/// Where two triangles overlap.
BR_HD inline Polygon overlap_of(const Target& a, const Target& b) {
  Polygon p;
  for (const Vec2& corner : a.x) p.corner[p.count++] = corner;
  for (int k = 0; k < 3; ++k)
    p = cut(p, [&](const Vec2& at) { return cross(b.x[(k + 1) % 3] - b.x[k], at - b.x[k]); });
  return p;
}

/// Integral of the potential of `of` over a polygon inside it.  [m2]
BR_HD inline double potential_integral(const Target& of, const Polygon& over) {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {  // the part where coordinate k is least
    Polygon part = over;
    for (int m = 1; m < 3; ++m)
      part = cut(part, [&](const Vec2& at) {
        double l[3];
        of.coordinates(at, l);
        return l[(k + m) % 3] - l[k];
      });
    sum += integral(part, [&](const Vec2& at) {
      double l[3];
      of.coordinates(at, l);
      return 3.0 * l[k];
    });
  }
  return sum;
}

/// What the plain forces lack to be the gradient of the pair's energy p (Int phi_a + Int phi_b):
/// the potential's own change of shape. Adds no force or moment to a triangle as a whole.
BR_HD inline void add_shape_forces(const Target& of, const Polygon& over, double penalty,
                                   Vec2 (&force)[3]) {
  const double size = penalty * potential_integral(of, over);
  for (int k = 0; k < 3; ++k) force[k] -= size * of.slope(k);
}

}  // namespace breccia::fdem
