#pragma once
// Couples by packs on the host: side by side where they do not meet, and where they do, the edges
// of one side by side. The same arithmetic for each edge as in turn, so the same bits.

#include <bit>

#include "fdem/contact/couples.hpp"
#include "math/lanes.hpp"

namespace breccia::fdem {

/// The six edges of a couple in the lanes of one pack, or of two; spare lanes repeat the last. For
/// couples that are not new, without conservative forces and losses: those that act, or meet.
template <class R>
struct EdgesSideBySide {
  static constexpr bool any_couple = false;
  static constexpr int at_once = width_of<R> >= 6 ? 6 : 3;

  bool near(const Vec2 (&)[3], const Vec2 (&)[3]) const { return true; }

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
      EdgePushOf<R> all;
      edge_push(law, scale, stiffness, before, dt, from, to, target, target_v, all);
      for (int k = 0; k < at_once; ++k) visit(first + k, lane(all, k));
    }
  }

 private:
  static EdgePush lane(const EdgePushOf<R>& all, int k) {
    EdgePush p;
    p.touches = all.touches[k] != 0;
    p.drag = all.drag[k];
    if (!p.touches) return p;
    for (int m = 0; m < 3; ++m) {
      p.overlap.at_a[m] = all.overlap.at_a[m][k];
      p.overlap.at_b[m] = all.overlap.at_b[m][k];
    }
    for (int end = 0; end < 2; ++end) {
      p.normal[end] = {all.normal[end].x[k], all.normal[end].y[k]};
      p.friction[end] = {all.friction[end].x[k], all.friction[end].y[k]};
    }
    p.taken = all.taken[k];
    p.sprung = all.sprung[k];
    p.stiffness = all.stiffness[k];
    return p;
  }
};

/// Phases of a pack of couples, a byte each: its lowest bit.
struct PhaseBits {
  std::uint64_t acting, resting;
  template <int width>
  static PhaseBits of(const CouplePhase* phase) {
    static_assert(width <= 8 && static_cast<int>(CouplePhase::rests) == 0 &&
                  static_cast<int>(CouplePhase::acts) == 1 &&
                  static_cast<int>(CouplePhase::waits) == 2);
    constexpr std::uint64_t one_each = 0x0101010101010101 >> 8 * (8 - width);
    std::uint64_t bytes = 0;
    __builtin_memcpy(&bytes, phase, width);
    return {bytes & one_each, ~(bytes | bytes >> 1) & one_each};
  }
};
/// Calls visit(k) for the couples of a pack that are among some bits.
template <class Visit>
inline void each_of(std::uint64_t bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<Index>(std::countr_zero(bits) / 8));
}

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
    const auto [acting, resting] = PhaseBits::of<width>(&kernel.phase[first]);
    bool is_new = false;
    each_of(acting, [&](Index k) { is_new = is_new || kernel.state[first + k].scale == 0.0; });
    if (is_new) break;
    std::uint64_t due = acting;
    if (resting != 0) {
      Vec2Of<R> xa[3], xb[3];
      corners(kernel.a, first, xa);
      corners(kernel.b, first, xb);
      const auto near = meet(xa, xb);
      if (any(near))
        each_of(resting, [&](Index k) {
          if (near[k] != 0) due |= std::uint64_t{1} << 8 * k;
        });
    }
    each_of(due, [&](Index k) { kernel.evaluate(first + k, EdgesSideBySide<R>{}); });
  }
  return first;
}

}  // namespace breccia::fdem
