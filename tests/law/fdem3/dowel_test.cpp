// A bar across a joint in space: its offset in two directions, and that its forces are the slopes
// of one energy, yielded or not.

#include "fdem_shared/bolts/dowel.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace breccia::fdem_shared {
namespace space_dowel_test {

using Carried = CarriedOf<Vec3>;

const Vec3 way{0.03, 0.04, 0.02};
const Carried at_one{{0.031, 0.038, 0.021}, {0.7, -0.6, 0.1}};
const Carried at_other{{0.028, 0.041, 0.019}, {0.8, -0.5, 0.2}};
const Dowel law{2e7, 1e9};

double stored(const Vec3& d, const Carried& one, const Carried& other, const Vec2& kept) {
  const Vec2 force = law.force(SpaceOffset::of(d, one, other).way, kept);
  return law.stored(norm(force));
}

/// A turn carries the bar along; with it slip of a joint, and the part of it that stays.
TEST(DowelInSpace, lies_out_of_line_by_slip_alone) {
  const Vec3 aside = (1.0 / norm(cross(way, {0.0, 0.0, 1.0}))) * cross(way, {0.0, 0.0, 1.0});
  const Vec3 other = (1.0 / norm(way)) * cross(way, aside);
  const Carried carried{way, aside};
  const auto even = [](const Vec3& v) {
    return Vec3{0.6 * v.x - 0.9 * v.y, 0.7 * v.x + v.y + 0.2 * v.z, v.z - 0.1 * v.x};
  };
  const Carried strained{even(way), even(aside)};
  EXPECT_NEAR(norm(SpaceOffset::of(even(way), strained, strained).way), 0.0, 1e-16);
  const Vec2 slip = SpaceOffset::of(way + 1e-3 * aside + 2e-3 * other, carried, carried).way;
  EXPECT_NEAR(slip.x, 1e-3, 1e-15);
  EXPECT_NEAR(slip.y, 2e-3, 1e-15);
}

/// By the way between its ends, the way that is carried and the direction across that is.
TEST(DowelInSpace, pushes_with_the_slopes_of_its_energy) {
  for (const Vec2 kept : {Vec2{}, Vec2{4e-3, -1e-3}}) {
    const SpaceOffset o = SpaceOffset::of(way, at_one, at_other);
    const Vec2 force = law.force(o.way, kept);
    const auto slope = [](const auto& energy) { return (energy(1e-7) - energy(-1e-7)) / 2e-7; };
    for (const Vec3& step : {Vec3{1.0, 0.0, 0.0}, Vec3{0.0, 1.0, 0.0}, Vec3{0.2, -0.3, 1.0}}) {
      const double size = 1e-6 * norm(force);
      EXPECT_NEAR(slope([&](double h) { return stored(way + h * step, at_one, at_other, kept); }),
                  dot(o.push(force), step), size);
      // A part of what is carried, along an edge that moves by `step`: the energy falls by the
      // forces' work.
      double along = 0.0, aside = 0.0;
      const auto work = [&](const Carried& parts) {
        double sum = 0.0;
        o.each_turn(force, parts, [&](double by, const Vec3& of, const Vec3& direction) {
          sum += by * of.x * dot(direction, step);
        });
        return sum;
      };
      along = work({{1.0, 0.0, 0.0}, {}});
      aside = work({{}, {1.0, 0.0, 0.0}});
      EXPECT_NEAR(slope([&](double h) {
                    return stored(way, {at_one.along + h * step, at_one.side}, at_other, kept);
                  }),
                  -along, size);
      EXPECT_NEAR(slope([&](double h) {
                    return stored(way, {at_one.along, at_one.side + h * step}, at_other, kept);
                  }),
                  -aside, size);
    }
  }
}

/// Pushed around in a circle beyond its strength: the force follows, no larger than that, and all
/// work is what it holds and what stayed took.
TEST(DowelInSpace, yields_alike_in_all_directions) {
  const Dowel weak{2e7, 5e3};
  Vec2 kept{}, force{}, last{};
  double work = 0.0, crushed = 0.0;
  constexpr int steps = 20000;
  for (int k = 0; k <= steps; ++k) {
    const double turn = 4.0 * k / steps, size = 1e-3 * std::min(1.0, turn);
    const Vec2 now{size * std::cos(turn), size * std::sin(turn)};
    const Vec2 before = force;
    force = weak.force(now, kept);
    const Vec2 beyond = weak.beyond(now, kept, force);
    kept += beyond;
    crushed += dot(force, beyond);
    work += 0.5 * dot(before + force, now - last);
    last = now;
    EXPECT_LE(norm(force), weak.strength * (1.0 + 1e-12));
  }
  EXPECT_NEAR(norm(force), weak.strength, 1e-3 * weak.strength);
  EXPECT_GT(crushed, 10.0 * weak.stored(norm(force)));
  EXPECT_NEAR(crushed + weak.stored(norm(force)), work, 1e-3 * work);
}

}  // namespace space_dowel_test
}  // namespace breccia::fdem_shared
