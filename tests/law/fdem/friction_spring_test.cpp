// The spring of friction of one edge that is moved by hand through a triangle.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fdem/contact/couples.hpp"

namespace breccia::fdem {
namespace friction_spring_test {

constexpr double dt = 1e-8, p_n = 3e11, p_t = 3e10, edge = 1e-3;

/// An edge along x of a body above, and a triangle whose corner has come up through it, so that
/// twice its depth is inside. All is turned by an angle.
struct Edge {
  ContactPair law;
  double angle = 0.0;
  double x = 0.0, depth = 0.0;  ///< of the corner  [m]
  EdgePush push{};
  double work = 0.0;      ///< that the force has taken, by the trapezoidal rule  [J/m]
  double spent = 0.0;     ///< [J/m]
  double given = 0.0;     ///< given back beyond what it was given, in steps without a turn  [J/m]
  double in_turns = 0.0;  ///< in steps in which the force turned round  [J/m]

  Vec2 turned(const Vec2& v) const {
    return {std::cos(angle) * v.x - std::sin(angle) * v.y,
            std::sin(angle) * v.x + std::cos(angle) * v.y};
  }
  /// Moves the corner there.
  void move(double to_x, double to_depth) {
    const Vec2 way = turned({to_x - x, to_depth - depth}), velocity = (1.0 / dt) * way;
    const double before = pull(), held = push.sprung;
    x = to_x;
    depth = to_depth;
    const double middle = 0.5 * edge + x;
    const Vec2 corner[3] = {turned({middle, depth}), turned({middle - edge, depth - edge}),
                            turned({middle + edge, depth - edge})};
    const EdgeEnd<double> from{turned({0.0, 0.0}), {}}, to{turned({edge, 0.0}), {}};
    const Vec2 v[3] = {velocity, velocity, velocity};
    const EdgePush last = push;
    push = {};
    edge_push(law, 1.0, last.stiffness, last.drag, dt, from, to, Target::of(corner), v, push);
    const double slip = dot(way, turned({1.0, 0.0}));
    work += 0.5 * (before + pull()) * slip;
    const double more = held + push.taken - push.sprung;
    spent += more;
    (before * pull() < 0.0 ? in_turns : given) += std::max(0.0, -more);
  }
  void move(double to_x, double to_depth, int steps) {
    const double from_x = x, from_depth = depth;
    for (int i = 1; i <= steps; ++i) {
      const double part = static_cast<double>(i) / steps;
      move(from_x + part * (to_x - from_x), from_depth + part * (to_depth - from_depth));
    }
  }
  /// On the edge, along x.  [N/m]
  double pull() const { return dot(push.friction[0] + push.friction[1], turned({1.0, 0.0})); }
  double normal() const { return norm(push.normal[0] + push.normal[1]); }
};

/// Slides where much of it is inside and back where little is, and the other way round: while it
/// sticks the spring pulls as before. It stays as stiff as the largest share made it, and gives
/// back what it was given, or less where it grew stiffer.
TEST(FrictionSpring, gives_back_no_more_than_it_was_given) {
  constexpr double slip = 1e-6;
  for (const double angle : {0.0, 0.7, -2.0})
    for (const auto& [first, then] : {std::pair{40e-6, 10e-6}, std::pair{10e-6, 40e-6}}) {
      Edge e{{p_n, p_t, 10.0}, angle};
      e.move(0.0, first, 50);
      const double k = p_t * 2.0 * first / edge, pull = k * slip, given = 0.5 * pull * slip;
      EXPECT_NEAR(e.push.stiffness, k, 1e-9 * k);
      e.move(slip, first, 50);
      EXPECT_NEAR(e.pull(), pull, 1e-9 * pull);
      EXPECT_NEAR(e.push.sprung, given, 1e-9 * given);

      e.move(slip, then, 50);
      const double most = p_t * 2.0 * std::max(first, then) / edge;
      const double held = 0.5 * pull * pull / most;
      EXPECT_NEAR(e.push.stiffness, most, 1e-9 * most);
      EXPECT_NEAR(e.pull(), pull, 1e-9 * pull);
      EXPECT_NEAR(e.push.sprung, held, 1e-9 * given);
      EXPECT_NEAR(e.spent, given - held, 1e-9 * given);
      EXPECT_NEAR(e.work, given, 1e-9 * given);

      e.move(slip - pull / most, then, 50);
      EXPECT_NEAR(e.pull(), 0.0, 1e-9 * pull);
      EXPECT_NEAR(e.work, given - held, 1e-9 * given);
      EXPECT_NEAR(e.spent, given - held, 1e-9 * given);
    }
}

/// A couple that has touched before with more of another edge inside is no softer for this one.
TEST(FrictionSpring, is_as_stiff_as_its_couple_has_been) {
  Edge e{{p_n, p_t, 10.0}};
  e.move(0.0, 10e-6, 50);
  e.push.stiffness = 0.7 * p_t;
  e.move(1e-6, 10e-6, 50);
  EXPECT_EQ(e.push.stiffness, 0.7 * p_t);
  EXPECT_NEAR(e.pull(), 0.7 * p_t * 1e-6, 1e-9 * e.pull());
  e.move(1e-6, -1e-6);
  EXPECT_FALSE(e.push.touches);
  EXPECT_EQ(e.push.drag, 0.0);
}

/// It bears what Coulomb allows, to rounding, and no more; what slip spends is T times slip.
TEST(FrictionSpring, slips_at_mu_times_the_normal_force) {
  Edge e{{p_n, p_t, 0.6}};
  e.move(0.0, 20e-6, 50);
  e.move(200e-6, 20e-6, 50);
  EXPECT_NEAR(e.pull(), 0.6 * e.normal(), 1e-12 * e.normal());
  const double spent = e.spent, pull = e.pull();
  e.move(205e-6, 20e-6, 7);
  EXPECT_NEAR(e.pull(), 0.6 * e.normal(), 1e-12 * e.normal());
  EXPECT_NEAR(e.spent - spent, pull * 5e-6, 1e-9 * spent);
}

/// Anywhere, at any speed, sticking, slipping and turning round it bears no more than Coulomb's
/// bound and gives back no more than it was given, but for steps in which the force turns round.
TEST(FrictionSpring, spends_and_never_gives) {
  for (const double mu : {0.05, 0.6, 5.0}) {
    Edge e{{p_n, p_t, mu}};
    unsigned bits = 1;
    const auto random = [&bits] {
      bits = bits * 1664525U + 1013904223U;
      return static_cast<double>(bits >> 8) / 8388608.0 - 1.0;
    };
    for (int i = 0; i < 3000; ++i) {
      const double to = 20e-6 * (1.0 + 0.999 * random()), aside = 300e-6 * random();
      e.move(aside, to, 1 + static_cast<int>(100.0 * std::abs(random())));
      ASSERT_LE(std::abs(e.pull()), (1.0 + 1e-12) * mu * e.normal());
    }
    EXPECT_LE(e.given, 1e-13 * e.spent);
    EXPECT_LE(e.in_turns, 0.01 * e.spent);
    EXPECT_GT(e.spent, 100.0 * e.push.sprung);
    EXPECT_NEAR(e.work, e.spent + e.push.sprung, 1e-9 * e.spent);
  }
}

}  // namespace friction_spring_test
}  // namespace breccia::fdem
