#pragma once
// Couples by packs on the host: side by side where they do not meet, and where they do, the edges
// of one side by side. The same arithmetic for each edge as in turn, so the same bits.

#include "fdem/contact/couples.hpp"
#include "math/lanes.hpp"

namespace breccia::fdem {

/// The six edges of a couple in the lanes of one pack, or of two; spare lanes repeat the last. For
/// couples that are not new, without conservative forces and losses.
template <class R>
struct EdgesSideBySide {
  static constexpr bool any_couple = false;
  static constexpr int at_once = width_of<R> >= 6 ? 6 : 3;
  bool are_near;

  bool near(const Vec2 (&)[3], const Vec2 (&)[3]) const { return are_near; }

  /// As EdgesInTurn.
  template <class Visit>
  void operator()(const ContactPair& law, double scale, double stiffness, const double (&drag)[6],
                  double dt, const Vec2 (&xa)[3], const Vec2 (&va)[3], const Target& of_a,
                  const Vec2 (&xb)[3], const Vec2 (&vb)[3], const Target& of_b,
                  const Visit& visit) const {
    for (int first = 0; first < 6; first += at_once) {
      const auto lanes = [first](const auto& number) {
        if constexpr (at_once == 6)
          return R{number(0), number(1), number(2), number(3),
                   number(4), number(5), number(5), number(5)};
        else
          return R{number(first), number(first + 1), number(first + 2), number(first + 2)};
      };
      const auto vectors = [&lanes](const auto& vector) {
        return Vec2Of<R>{lanes([&](int e) { return vector(e).x; }),
                         lanes([&](int e) { return vector(e).y; })};
      };
      const auto corner = [](int e) { return e < 3 ? e : e - 3; };
      const auto next = [](int e) { return e == 2 || e == 5 ? 0 : e < 3 ? e + 1 : e - 2; };
      const EdgeEnd<R> from{vectors([&](int e) { return (e < 3 ? xa : xb)[corner(e)]; }),
                            vectors([&](int e) { return (e < 3 ? va : vb)[corner(e)]; })};
      const EdgeEnd<R> to{vectors([&](int e) { return (e < 3 ? xa : xb)[next(e)]; }),
                          vectors([&](int e) { return (e < 3 ? va : vb)[next(e)]; })};
      TargetOf<R> target;
      Vec2Of<R> target_v[3];
      for (int m = 0; m < 3; ++m) {
        target.x[m] = vectors([&](int e) { return (e < 3 ? xb : xa)[m]; });
        target_v[m] = vectors([&](int e) { return (e < 3 ? vb : va)[m]; });
      }
      target.over_double = lanes([&](int e) { return (e < 3 ? of_b : of_a).over_double; });
      const R before = lanes([&](int e) { return drag[e]; });
      const EdgePushOf<R> all =
          edge_push(law, scale, stiffness, before, dt, from, to, target, target_v);
      for (int k = 0; k < at_once; ++k) visit(first + k, lane(all, k));
    }
  }

 private:
  static EdgePush lane(const EdgePushOf<R>& all, int k) {
    EdgePush p;
    p.touches = all.touches[k] != 0;
    if (!p.touches) return p;
    for (int m = 0; m < 3; ++m) {
      p.overlap.at_a[m] = all.overlap.at_a[m][k];
      p.overlap.at_b[m] = all.overlap.at_b[m][k];
    }
    for (int end = 0; end < 2; ++end) {
      p.normal[end] = {all.normal[end].x[k], all.normal[end].y[k]};
      p.friction[end] = {all.friction[end].x[k], all.friction[end].y[k]};
    }
    p.drag = all.drag[k];
    p.taken = all.taken[k];
    p.sprung = all.sprung[k];
    p.stiffness = all.stiffness[k];
    return p;
  }
};

/// Couples [begin, end) by packs. @returns where it stops: at what does not fill a pack, or at a
/// pack with a new couple
template <class R, class Number>
inline Index run_couples(const CoupleForces<Number>& kernel, Index begin, Index end) {
  if (kernel.conservative || kernel.rebound.loses()) return begin;
  constexpr Index width = width_of<R>;
  const auto corners = [&kernel](const View<const Index>& of, Index first, Vec2Of<R>(&x)[3]) {
    R numbers[12];
    gather_records(kernel.nodes, load_indices<R>(of, first), numbers);
    for (int k = 0; k < 3; ++k) x[k] = {numbers[4 * k], numbers[4 * k + 1]};
  };
  Index first = begin;
  for (; first + width <= end; first += width) {
    bool is_new = false;
    for (Index k = 0; k < width; ++k) is_new = is_new || kernel.state[first + k].scale == 0.0;
    if (is_new) break;
    Vec2Of<R> xa[3], xb[3];
    corners(kernel.a, first, xa);
    corners(kernel.b, first, xb);
    const auto near = meet(xa, xb);
    for (Index k = 0; k < width; ++k) {
      const CoupleState& kept = kernel.state[first + k];
      const bool are_near = near[k] != 0;
      if (are_near || kept.work != 0.0 || kept.slid != 0.0)
        kernel.evaluate(first + k, EdgesSideBySide<R>{are_near});
      else
        kernel.force[first + k] = {};
    }
  }
  return first;
}

}  // namespace breccia::fdem
