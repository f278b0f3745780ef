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

/// Distance along an axis from all corners of one element to all of the other. Below zero where
/// they overlap along it, and for an axis without length.  [m]
template <class Vector, int corners>
BR_HD double gap_along(const Vector& axis, const Vector (&a)[corners], const Vector (&b)[corners]) {
  const double size = norm(axis);
  if (!(size > 0.0)) return -1.0;
  double low_a = 0.0, high_a = 0.0;  // from corner 0 of a, so that places far out lose no digits
  double low_b = dot(axis, b[0] - a[0]), high_b = low_b;
  for (int k = 1; k < corners; ++k) {
    const double of_a = dot(axis, a[k] - a[0]), of_b = dot(axis, b[k] - a[0]);
    low_a = min(low_a, of_a);
    high_a = max(high_a, of_a);
    low_b = min(low_b, of_b);
    high_b = max(high_b, of_b);
  }
  return max(low_b - high_a, low_a - high_b) / size;
}

/// Whether tetrahedra are further apart than a distance; as far as the axes of sides and of pairs
/// of edges tell.
BR_HD inline bool are_separated(const Vec3 (&a)[4], const Vec3 (&b)[4], double distance) {
  Vec3 edge_a[6], edge_b[6];
  int count = 0;
  for (int k = 0; k < 4; ++k)
    for (int m = k + 1; m < 4; ++m) {
      edge_a[count] = a[m] - a[k];
      edge_b[count] = b[m] - b[k];
      ++count;
    }
  constexpr int side[4][2] = {{0, 1}, {0, 2}, {1, 2}, {3, 4}};  // edges of each
  for (const auto& [first, second] : side)
    if (gap_along(cross(edge_a[first], edge_a[second]), a, b) > distance ||
        gap_along(cross(edge_b[first], edge_b[second]), a, b) > distance)
      return true;
  for (const Vec3& of_a : edge_a)
    for (const Vec3& of_b : edge_b)
      if (gap_along(cross(of_a, of_b), a, b) > distance) return true;
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
    const double near = Shape::near(shape[a[i]]) + Shape::near(shape[b[i]]);
    if (!stay_apart(reference[p].at, reference[q].at, margin[p] + margin[q] + near)) return true;
    const Index at = lower_bound(last_key.data, 0, last_key.size, key[i]);
    if (at == last_key.size || last_key[at] != key[i]) return false;
    return last_state[at].work != 0.0 || last_state[at].slid != 0.0;
  }
};

}  // namespace breccia::fdem_shared
