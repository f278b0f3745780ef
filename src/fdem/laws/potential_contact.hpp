#pragma once
// Contact of two triangles by the potential of Munjiza and Andrews (2000).

#include "math/vec2.hpp"

namespace breccia::fdem {

/// A triangle seen by the points of another: where a point lies in it. R is double, or a pack.
template <class R>
struct TargetOf {
  Vec2Of<R> x[3];  ///< corners, counter-clockwise  [m]
  R over_double;   ///< 1 / (2 area)  [1/m2]

  BR_HD static TargetOf of(const Vec2Of<R> (&corner)[3]) {
    return {{corner[0], corner[1], corner[2]},
            1.0 / cross(corner[1] - corner[0], corner[2] - corner[0])};
  }
  /// Area coordinates of a point; they sum to 1.
  BR_HD void coordinates(const Vec2Of<R>& p, R (&l)[3]) const {
    l[1] = over_double * cross(p - x[0], x[2] - x[0]);
    l[2] = over_double * cross(x[1] - x[0], p - x[0]);
    l[0] = over_double * cross(x[2] - x[1], p - x[1]);
  }
  /// Area coordinate k, to the bit; k need not be known in advance.
  BR_HD R coordinate(int k, const Vec2Of<R>& p) const {
    const Vec2Of<R> from = k == 0 ? x[1] : x[0];
    const Vec2Of<R> edge = (k == 2 ? x[1] : x[2]) - from, way = p - from;
    const R one = edge.x * way.y, other = edge.y * way.x;
    return over_double * ((k == 1 ? other : one) - (k == 1 ? one : other));
  }
  /// Gradient of area coordinate k.  [1/m]
  BR_HD Vec2Of<R> slope(int k) const {
    const Vec2Of<R> edge = x[(k + 2) % 3] - x[(k + 1) % 3];
    return over_double * Vec2Of<R>{-edge.y, edge.x};
  }
};
using Target = TargetOf<double>;

/// Whether a line along an edge of the target has all these corners clearly outside: no edge of
/// either overlaps the other then, however numbers round.
template <class R>
BR_HD inline auto outside(const Vec2Of<R> (&corner)[3], const TargetOf<R>& target) {
  constexpr double clearly = -1e-9;
  R l[3][3];
  for (int k = 0; k < 3; ++k) target.coordinates(corner[k], l[k]);
  auto beyond = l[0][0] < clearly && l[1][0] < clearly && l[2][0] < clearly;
  for (int k = 1; k < 3; ++k)
    beyond = beyond || (l[0][k] < clearly && l[1][k] < clearly && l[2][k] < clearly);
  return beyond;
}
/// Whether boxes around two triangles have a point in common.
template <class R>
BR_HD inline auto boxes_meet(const Vec2Of<R> (&p)[3], const Vec2Of<R> (&q)[3]) {
  const auto apart = [](const R& p0, const R& p1, const R& p2, const R& q0, const R& q1,
                        const R& q2) {
    return max(p0, max(p1, p2)) < min(q0, min(q1, q2)) ||
           max(q0, max(q1, q2)) < min(p0, min(p1, p2));
  };
  return !(apart(p[0].x, p[1].x, p[2].x, q[0].x, q[1].x, q[2].x) ||
           apart(p[0].y, p[1].y, p[2].y, q[0].y, q[1].y, q[2].y));
}
/// False only where nothing can touch: forces would be zero without asking.
template <class R>
BR_HD inline auto meet(const Vec2Of<R> (&p)[3], const Vec2Of<R> (&q)[3]) {
  const auto near = boxes_meet(p, q);
  if (!any(near)) return near;
  return near && !outside(p, TargetOf<R>::of(q)) && !outside(q, TargetOf<R>::of(p));
}

/// Path of an edge inside another triangle, with the potential phi = 3 min(l0, l1, l2): 0 on the
/// border, 1 in the middle.
template <class R>
struct EdgeOverlapOf {
  R whole{};           ///< integral of phi over s, the share of the edge  [-]
  R moment{};          ///< integral of phi s over s  [-]
  R begin, end;        ///< the part of the edge that lies inside, in s  [-]
  R at_a[3], at_b[3];  ///< area coordinates of the edge's ends in the target  [-]
};
using EdgeOverlap = EdgeOverlapOf<double>;

/// An edge through a target, by its ends' area coordinates there. False if no part of it lies
/// inside. Exact: phi is linear between the breaks where two area coordinates are least together
/// (Munjiza 2004, 2.50-2.56).
template <class R>
BR_HD inline auto overlap_of_ends(EdgeOverlapOf<R>& o) {
  o.begin = constant<R>(0.0);
  o.end = constant<R>(1.0);
  auto inside = o.end > o.begin;
  for (int k = 0; k < 3; ++k) {
    const R la = o.at_a[k], lb = o.at_b[k];
    inside = inside && !(la <= 0.0 && lb <= 0.0);
    if (!any(inside)) return inside;
    const auto begins = la < 0.0, ends = lb < 0.0;
    if (!any(begins || ends)) continue;
    const R at = la / (la - lb);
    o.begin = select(begins, max(o.begin, at), o.begin);
    o.end = select(ends, min(o.end, at), o.end);
  }
  inside = inside && o.end > o.begin;
  if (!any(inside)) return inside;

  // Breaks, ascending; where there are fewer than three, the end again.
  R s[5] = {o.begin, o.end, o.end, o.end, o.end};
  for (int k = 0; k < 3; ++k) {
    const int m = (k + 1) % 3, other = (k + 2) % 3;
    const R difference_a = o.at_a[k] - o.at_a[m], difference_b = o.at_b[k] - o.at_b[m];
    const R change = difference_a - difference_b;
    auto breaks = change != 0.0;
    if (!any(breaks)) continue;
    R at = difference_a / change;
    breaks = breaks && at > o.begin && at < o.end;
    if (!any(breaks)) continue;
    const R least = o.at_a[k] + at * (o.at_b[k] - o.at_a[k]);
    breaks = breaks && !(least > o.at_a[other] + at * (o.at_b[other] - o.at_a[other]));
    if (!any(breaks)) continue;
    at = select(breaks, at, o.end);  // one more end leaves them as they are
    for (int i = 1; i < 4; ++i) {    // an index that is not known in advance costs GPUs much
      const R here = min(s[i], at);
      at = max(s[i], at);
      s[i] = here;
    }
  }

  const auto phi = [&o](const R& at) {
    R least = constant<R>(1.0);
    for (int k = 0; k < 3; ++k) least = min(least, o.at_a[k] + at * (o.at_b[k] - o.at_a[k]));
    return 3.0 * max(constant<R>(0.0), least);
  };
  o.whole = constant<R>(0.0);
  o.moment = constant<R>(0.0);
  R before = phi(s[0]);
  for (int i = 0; i < 4; ++i) {
    const R width = s[i + 1] - s[i];
    if (!any(width > 0.0)) continue;  // most edges have no more than one break
    const R after = phi(s[i + 1]);
    o.whole += 0.5 * width * (before + after);
    o.moment +=
        (1.0 / 6.0) * width * (before * (2.0 * s[i] + s[i + 1]) + after * (s[i] + 2.0 * s[i + 1]));
    before = after;
  }
  return inside && o.whole > 0.0;
}

/// The edge a -> b through a target.
template <class R>
BR_HD inline auto overlap_of_edge(const Vec2Of<R>& a, const Vec2Of<R>& b, const TargetOf<R>& target,
                                  EdgeOverlapOf<R>& o) {
  target.coordinates(a, o.at_a);
  target.coordinates(b, o.at_b);
  return overlap_of_ends(o);
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
template <class R>
BR_HD inline void normal_forces(const EdgeOverlapOf<R>& o, const Vec2Of<R>& a, const Vec2Of<R>& b,
                                double penalty, Vec2Of<R>& on_a, Vec2Of<R>& on_b) {
  const Vec2Of<R> outward{penalty * (b.y - a.y), penalty * (a.x - b.x)};  // times the edge's length
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

/// Terms that make the plain forces the gradient of the pair's energy p (Int phi_a + Int phi_b):
/// the potential's own change of shape. Adds no force or moment to a triangle as a whole.
BR_HD inline void add_shape_forces(const Target& of, const Polygon& over, double penalty,
                                   Vec2 (&force)[3]) {
  const double size = penalty * potential_integral(of, over);
  for (int k = 0; k < 3; ++k) force[k] -= size * of.slope(k);
}

}  // namespace breccia::fdem
