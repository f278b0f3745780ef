#pragma once
// Which edges another triangle is so near to that contact may begin: those whose stiffness counts
// in the time step (docs/theory-fdem.md, 5).

#include "core/incidence.hpp"
#include "fdem/laws/potential_contact.hpp"
#include "fdem/triangles/triangles.hpp"
#include "fdem_shared/couple_phase.hpp"

namespace breccia::fdem {

/// How near a triangle's surroundings count as near; it goes with its size at the start, so that
/// neither its state nor a search changes it.  [m]
/// @param shape_inverse  see Triangles
BR_HD inline double near_reach(const Mat2& shape_inverse) {
  constexpr double share = 0.02;  // of the square root of twice the area
  return share / sqrt(determinant(shape_inverse));
}

/// Square of the distance of a point from the line between two others.  [m2]
BR_HD inline double squared_distance(const Vec2& p, const Vec2& from, const Vec2& to) {
  const Vec2 along = to - from, way = p - from;
  const double s = max(0.0, min(1.0, dot(way, along) / dot(along, along)));
  const Vec2 apart = way - s * along;
  return dot(apart, apart);
}

/// Triangles near each other. Searches list all pairs within the sum of both reaches, whatever
/// their margin; so what is near depends on positions alone.
struct Nearness {
  View<const TriangleNodes> nodes;
  View<const Mat2> shape_inverse;
  IncidenceView couples;
  View<const Index> couple_a, couple_b;
  View<const fdem_shared::CouplePhase> phase;
  View<const Index> joint_a, joint_b;  ///< edges of the joints

  BR_HD double reach(Index t) const { return near_reach(shape_inverse[t]); }

  /// Of the edges of triangle t in a set of bits, those that another triangle is near to.
  /// @param x  corners of t
  BR_HD int edges_near(Index t, const Vec2 (&x)[3], int edges) const {
    int near = 0;
    const Index last = couples.last(t);
    for (Index c = couples.first(t); c < last && near != edges; ++c) {
      const Index couple = pair_of(couples.entries[c]);
      if (phase[couple] == fdem_shared::CouplePhase::waits) continue;
      const Index other = side_of(couples.entries[c]) == 0 ? couple_b[couple] : couple_a[couple];
      near |= near_to(t, x, other, edges & ~near);
    }
    return near;
  }
  /// Edges near the triangle across a joint: asked at once when it breaks, before a search lists
  /// it.
  BR_HD int edges_near_across(Index t, const Vec2 (&x)[3], Entry joint, int edges) const {
    const View<const Index>& other = side_of(joint) == 0 ? joint_b : joint_a;
    return near_to(t, x, other[pair_of(joint)] / 3, edges);
  }

 private:
  BR_HD int near_to(Index t, const Vec2 (&x)[3], Index other, int edges) const {
    Vec2 y[3], v[3];
    split(nodes[other], y, v);
    const double allowed = reach(t) + reach(other);
    if (boxes_apart(x, y, allowed)) return 0;
    if (!outside(x, Target::of(y)) && !outside(y, Target::of(x))) return edges;
    int near = 0;
    for (int k = 0; k < 3; ++k) {
      if ((edges >> k & 1) == 0) continue;
      const Vec2 &from = x[k], &to = x[k == 2 ? 0 : k + 1];
      double least = 1e300;
      for (int m = 0; m < 3; ++m) {
        const Vec2& next = y[m == 2 ? 0 : m + 1];
        least = min(least, squared_distance(y[m], from, to));
        least = min(least, squared_distance(from, y[m], next));
        least = min(least, squared_distance(to, y[m], next));
      }
      if (least <= allowed * allowed) near |= 1 << k;
    }
    return near;
  }
  BR_HD static bool boxes_apart(const Vec2 (&p)[3], const Vec2 (&q)[3], double by) {
    const auto gap = [](double p0, double p1, double p2, double q0, double q1, double q2) {
      return min(p0, min(p1, p2)) - max(q0, max(q1, q2));
    };
    return gap(p[0].x, p[1].x, p[2].x, q[0].x, q[1].x, q[2].x) > by ||
           gap(q[0].x, q[1].x, q[2].x, p[0].x, p[1].x, p[2].x) > by ||
           gap(p[0].y, p[1].y, p[2].y, q[0].y, q[1].y, q[2].y) > by ||
           gap(q[0].y, q[1].y, q[2].y, p[0].y, p[1].y, p[2].y) > by;
  }
};

}  // namespace breccia::fdem
