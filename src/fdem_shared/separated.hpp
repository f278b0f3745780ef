#pragma once
// Couples that cannot come near each other before the next search: they are not listed.
//
// Boxes overlap where elements do not: in a block of cubes that are cut into six tetrahedra each, a
// search finds 40 pairs an element, of which none touches.
//
// Claim: two elements with margins m_a and m_b (core/travel.hpp) do not touch as long as both are
// within them, if at the search a plane has all corners of a on one side, and those of b further
// than m_a + m_b beyond it. Proof: in the frame of the drift no corner moves further than its
// element's margin. With n the plane's normal, every corner of a stays at n x <= m_a, every one of
// b at n x > m_a + m_b - m_b. Both elements are convex.
//
// Two convex polyhedra that do not touch are kept apart by a plane along a side of one of them or
// along an edge of each (Gottschalk, Lin and Manocha 1996), so no other directions are tried. A
// small distance is left over, far more than rounding in laws of contact.

#include "core/rows.hpp"
#include "exec/for_each.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Corners of two elements as axes see them: from corner 0 of the first, so that places far out
/// lose no digits.
template <class Vector, int corners>
struct CornersApart {
  Vector of_a[corners], of_b[corners];  ///< [m]; of_a[0] is zero
  double distance;                      ///< above 0  [m]

  BR_HD CornersApart(const Vector (&a)[corners], const Vector (&b)[corners], double wanted)
      : distance(wanted) {
    for (int k = 0; k < corners; ++k) {
      of_a[k] = a[k] - a[0];
      of_b[k] = b[k] - a[0];
    }
  }
  /// Whether all corners of one are further than the distance from all of the other along an axis.
  BR_HD bool along(const Vector& axis) const {
    double low_a = 0.0, high_a = 0.0;
    double low_b = dot(axis, of_b[0]), high_b = low_b;
    for (int k = 1; k < corners; ++k) {
      const double in_a = dot(axis, of_a[k]), in_b = dot(axis, of_b[k]);
      low_a = min(low_a, in_a);
      high_a = max(high_a, in_a);
      low_b = min(low_b, in_b);
      high_b = max(high_b, in_b);
    }
    const double gap = max(low_b - high_a, low_a - high_b);  // times the length of the axis
    if (!(gap > 0.0)) return false;
    const double size = norm(axis);
    return size > 0.0 && gap / size > distance;
  }
};

/// Whether tetrahedra are further apart than a distance; as far as the axes of sides and of pairs
/// of edges tell.
/// @param distance  above 0  [m]
BR_HD inline bool are_separated(const Vec3 (&a)[4], const Vec3 (&b)[4], double distance) {
  Vec3 edge_a[6], edge_b[6];
  int count = 0;
  for (int k = 0; k < 4; ++k)
    for (int m = k + 1; m < 4; ++m) {
      edge_a[count] = a[m] - a[k];
      edge_b[count] = b[m] - b[k];
      ++count;
    }
  const CornersApart<Vec3, 4> corners(a, b, distance);
  constexpr int side[4][2] = {{0, 1}, {0, 2}, {1, 2}, {3, 4}};  // edges of each
  for (const auto& [first, second] : side)
    if (corners.along(cross(edge_a[first], edge_a[second])) ||
        corners.along(cross(edge_b[first], edge_b[second])))
      return true;
  for (const Vec3& of_a : edge_a)
    for (const Vec3& of_b : edge_b)
      if (corners.along(cross(of_a, of_b))) return true;
  return false;
}

/// Whether a corner of one element is no further from one of the other than a way.
template <class Vector, int corners>
BR_HD bool corners_within(const Vector (&a)[corners], const Vector (&b)[corners], double way) {
  for (const Vector& of_a : a)
    for (const Vector& of_b : b)
      if (dot(of_b - of_a, of_b - of_a) <= way * way) return true;
  return false;
}

template <class Vector, int corners>
BR_HD double longest_edge_at_first(const Vector (&x)[corners]) {
  double squared = 0.0;
  for (int k = 1; k < corners; ++k) squared = max(squared, dot(x[k] - x[0], x[k] - x[0]));
  return sqrt(squared);
}

/// Whether elements are further apart than a way that they may go, with a little left over.
template <class Corners>
BR_HD bool stay_apart(const Corners& a, const Corners& b, double way) {
  constexpr double left_over = 1e-6;
  const double size = longest_edge_at_first(a) + longest_edge_at_first(b);
  return are_separated(a, b, way + left_over * (size + way));
}

/// Whether a couple is to be listed: its elements may be near each other before the next search, or
/// it holds something that its forces must give back first.
template <class Shape, class State>
struct MayBeNear {
  View<const Index> a, b;
  View<const PairKey> key;
  View<const Index> place;  ///< of elements in the next two
  View<const typename Shape::CornersOfElement> reference;
  View<const double> margin;
  View<const typename Shape::Reference> shape;
  View<const PairKey> last_key;  ///< of the couples so far
  View<const State> last_state;

  BR_HD bool operator()(Index i) const {
    const Index p = place[a[i]], q = place[b[i]];
    // No axis has corners further apart than they are: what was joined is known without axes.
    if (corners_within(reference[p].at, reference[q].at, margin[p] + margin[q])) return true;
    const double near = Shape::near(shape[a[i]]) + Shape::near(shape[b[i]]);
    if (!stay_apart(reference[p].at, reference[q].at, margin[p] + margin[q] + near)) return true;
    const Index at = lower_bound(last_key.data, 0, last_key.size, key[i]);
    if (at == last_key.size || last_key[at] != key[i]) return false;
    return last_state[at].work != 0.0 || last_state[at].slid != 0.0;
  }
};

}  // namespace breccia::fdem_shared
