#include "dem/laws/concrete_link.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/constants.hpp"
#include "pair_driver.hpp"

namespace breccia::dem {
namespace concrete_link_test {

using testing::Pair;

constexpr double length = 0.02, stiffness = 2e8, area = 3e-4, radius = 0.01;
const LinkConstants<double> link{length, stiffness, area, radius, 2.0 * radius};

ConcreteLink law(double brittle = 0.0) {
  ConcreteLink l{};
  l.tensile_strength = 2.2e6;
  l.cohesion = 5.5e6;
  l.softening = 10.0;
  l.friction = std::tan(0.5);
  l.broken_friction = std::tan(0.6);
  l.shear_ratio = 0.18;
  l.rolling_ratio = 1.0;
  l.rolling_limit = l.broken_rolling_limit = 0.15;
  l.brittle_shear = brittle;
  return l;
}
const double strength = 2.2e6 * area;       // S T
const double onset = strength / stiffness;  // u_1
const double rupture = 11.0 * onset;        // u_2

/// Moves b along x to a stretch, in steps; returns the work done on the link by the trapezoid of N.
double pull(const ConcreteLink& l, LinkState<double>& state, Pair& pair, double stretch,
            int steps) {
  double work = 0.0;
  double before = norm(pair.b.position - pair.a.position) - length;
  const double each = (stretch - before) / steps;
  LinkState<double> probe = state;
  double normal = l.response(link, pair.move_b({}), probe).normal;
  for (int i = 0; i < steps; ++i) {
    const LinkResponse<double> r = l.response(link, pair.move_b({each / pair.dt, 0.0, 0.0}), state);
    work += 0.5 * (normal + r.normal) * each;
    normal = r.normal;
  }
  return work;
}

TEST(ConcreteLink, pulling_it_apart_costs_the_area_under_the_curve) {
  for (const int steps : {2'000, 20'000}) {
    LinkState<double> state{};
    Pair pair;
    const double work = pull(law(), state, pair, 1.05 * rupture, steps);
    EXPECT_NEAR(work, 0.5 * strength * rupture, 2e-3 * 0.5 * strength * rupture);
    EXPECT_EQ(state.opening, link_broken);
  }
}

TEST(ConcreteLink, with_a_given_rupture_opening_costs_its_energy_whatever_its_length) {
  ConcreteLink l = law();
  l.rupture_opening = rupture;
  for (const double stiffer : {0.5, 1.0, 4.0}) {  // as long and short links are
    const LinkConstants<double> own{length, stiffer * stiffness, area, radius, 2.0 * radius};
    const double first = strength / own.stiffness, energy = 0.5 * strength * rupture;
    LinkState<double> state{};
    Pair pair;
    double work = 0.0, before = 0.0;
    for (int i = 1; i <= 20'000; ++i) {
      const double u = 1.01 * rupture * i / 20'000;
      pair.b.position.x = length + u;
      const double n = l.response(own, pair.move_b({}), state).normal;
      const double expected = u <= first    ? own.stiffness * u
                              : u < rupture ? strength * (rupture - u) / (rupture - first)
                                            : 0.0;
      ASSERT_NEAR(n, expected, 1e-9 * strength) << "u / u_2 = " << u / rupture;
      work += 0.5 * (before + n) * 1.01 * rupture / 20'000;
      before = n;
    }
    EXPECT_NEAR(work, energy, 1e-3 * energy);
    EXPECT_EQ(state.opening, link_broken);
    EXPECT_NEAR(l.tension(own).spent(rupture), energy, 1e-12 * energy);
  }
}

TEST(ConcreteLink, is_known_to_be_whole_without_a_division) {
  const ConcreteLink l = law();
  const TensionSoftening<double> t = l.tension(link);
  for (const double share : {0.0, 0.5, 0.999, 1.0 - 1e-13, 1.0, 1.0 + 1e-13, 1.001, 3.0, 10.9}) {
    EXPECT_EQ(l.damage(link, share * onset), share == 0.0 ? 0.0 : t.damage(share * onset)) << share;
    EXPECT_EQ(l.spent(link, share * onset), t.spent(share * onset)) << share;
  }
  EXPECT_TRUE(t.whole(0.999 * onset));
  EXPECT_FALSE(t.whole(onset));
}

TEST(ConcreteLink, the_peak_is_the_strength_and_the_fall_is_linear) {
  LinkState<double> state{};
  Pair pair;
  double peak = 0.0;
  for (int i = 1; i <= 11'000; ++i) {
    const double u = i * rupture / 10'000;
    pair.b.position.x = length + u;
    const double n = law().response(link, pair.move_b({}), state).normal;
    peak = std::max(peak, n);
    const double expected = u <= onset    ? stiffness * u
                            : u < rupture ? strength - stiffness / 10.0 * (u - onset)
                                          : 0.0;
    ASSERT_NEAR(n, expected, 1e-9 * strength) << "u / u_1 = " << u / onset;
  }
  EXPECT_NEAR(peak, strength, 2e-3 * strength);
}

/// The area under two lines of tension, closed: what is spent and stored is the work done, on the
/// way as at the end; beyond the knee unloading is still the secant.
TEST(ConcreteLink, with_a_knee_falls_along_two_lines_and_books_their_area) {
  ConcreteLink l = law();
  const double s = 1.0 / 3.0, x = 2.0 / 9.0;  // Petersson's
  l.knee = {(1.0 - s) / x, s / (1.0 - x), s + x};
  const double bend = onset + x * (rupture - onset);
  const auto line = [&](double u) {
    if (u <= onset) return stiffness * u;
    if (u <= bend) return strength * (1.0 - (1.0 - s) * (u - onset) / (bend - onset));
    return u < rupture ? strength * s * (rupture - u) / (rupture - bend) : 0.0;
  };
  const double energy =
      0.5 * strength * (onset + (1.0 + s) * (bend - onset) + s * (rupture - bend));
  for (const bool given : {false, true}) {
    l.rupture_opening = given ? rupture : 0.0;
    EXPECT_NEAR(l.tension(link).toughness(), energy, 1e-14 * energy);
    LinkState<double> state{};
    Pair pair;
    double work = 0.0, before = 0.0, broke = 0.0;
    constexpr int steps = 20'000;
    for (int i = 1; i <= steps; ++i) {
      const double u = 1.01 * rupture * i / steps;
      pair.b.position.x = length + u;
      const LinkResponse<double> r = l.response(link, pair.move_b({}), state);
      ASSERT_NEAR(r.normal, line(u), 1e-9 * strength) << "u / u_2 = " << u / rupture;
      work += 0.5 * (before + r.normal) * 1.01 * rupture / steps;
      before = r.normal;
      broke += r.broke;
      if (state.opening < 0.0) continue;
      const double kept = l.spent(link, state.opening) + l.stored(link, u, state);
      ASSERT_NEAR(kept, work, 1e-5 * energy) << "u / u_2 = " << u / rupture;
      if (i % 997 != 0) continue;
      LinkState<double> back = state;  // half way back: half the force
      pair.b.position.x = length + 0.5 * u;
      ASSERT_NEAR(l.response(link, pair.move_b({}), back).normal, 0.5 * line(u), 1e-9 * strength);
    }
    EXPECT_NEAR(broke, energy, 1e-12 * energy);
    EXPECT_NEAR(work, energy, 1e-3 * energy);
  }
}

TEST(ConcreteLink, unloading_goes_to_the_origin_and_gains_nothing) {
  LinkState<double> state{};
  Pair pair;
  pull(law(), state, pair, 4.0 * onset, 4'000);
  const double opened = state.opening;
  const double down = pull(law(), state, pair, 0.0, 1'000);
  const double secant = (strength - stiffness / 10.0 * 3.0 * onset) / (4.0 * onset);
  EXPECT_NEAR(down, -0.5 * secant * 16.0 * onset * onset, 1e-9);
  const double up = pull(law(), state, pair, 4.0 * onset, 1'000);
  EXPECT_NEAR(up + down, 0.0, 1e-8 * up);
  EXPECT_NEAR(state.opening, opened, 1e-8 * opened);
}

TEST(ConcreteLink, compression_is_elastic_without_limit_even_after_damage_and_rupture) {
  LinkState<double> state{};
  Pair pair;
  for (const double opened : {0.0, 4.0 * onset, 1.1 * rupture}) {
    pull(law(), state, pair, opened, 2'000);
    pair.b.position.x = length - 20.0 * onset;
    EXPECT_NEAR(law().response(link, pair.move_b({}), state).normal, -20.0 * strength,
                1e-6 * strength);
  }
}

/// Slides b along y under a fixed stretch; returns the last response and adds up what sliding
/// spent.
LinkResponse<double> slide(const ConcreteLink& l, LinkState<double>& state, Pair& pair,
                           double stretch, double path, double& spent) {
  LinkResponse<double> r{};
  const int steps = 2'000;
  for (int i = 0; i < steps; ++i) {
    // The contact point slides while the centres stay: spins about z, equal on both ends.
    pair.b.position = {length + stretch, 0.0, 0.0};
    const double spin = -path / steps / pair.dt / (length + stretch);
    r = l.response(link, pair.step({}, {0.0, 0.0, spin}, {}, {0.0, 0.0, spin}), state);
    spent += r.slid;
  }
  return r;
}

TEST(ConcreteLink, shear_under_pressure_ends_on_the_mohr_coulomb_line) {
  const double p = 3.0 * strength, u = -p / stiffness;
  const double plateau = 5.5e6 * area + p * std::tan(0.5);
  LinkState<double> state{};
  Pair pair;
  double spent = 0.0;
  const double path = 40.0 * plateau / (0.18 * stiffness);
  const LinkResponse<double> r = slide(law(), state, pair, u, path, spent);
  EXPECT_NEAR(norm(r.shear), plateau, 1e-9 * plateau);
  // dissipated: plateau times slip beyond the elastic part
  EXPECT_NEAR(spent, plateau * (path - plateau / (0.18 * stiffness)), 2e-3 * spent);
}

/// The hyperbola through (T, 0) whose asymptote is the line of cohesion and friction.
double on_hyperbola(double stress) {
  const double slope = std::tan(0.5), c = 5.5e6, t = 2.2e6;
  return std::sqrt(std::pow(c - stress * slope, 2) - std::pow(c - t * slope, 2));
}

TEST(ConcreteLink, shear_may_end_on_a_hyperbola_that_meets_the_tensile_strength) {
  ConcreteLink l = law();
  l.hyperbolic = 1.0;
  double spent = 0.0;
  for (const double stress : {-300e6, -6.6e6, 0.0, 1.1e6, 2.0e6}) {
    LinkState<double> state{};
    Pair pair;
    const double plateau = on_hyperbola(stress) * area;
    const double path = 5.0 * plateau / (0.18 * stiffness);
    const LinkResponse<double> r =
        slide(l, state, pair, stress * area / stiffness, path, spent = 0.0);
    EXPECT_NEAR(norm(r.shear), plateau, 1e-9 * plateau) << stress;
    EXPECT_NEAR(spent, plateau * (path - plateau / (0.18 * stiffness)), 2e-3 * spent) << stress;
  }
  const double line = 5.5e6 + 300e6 * std::tan(0.5);
  EXPECT_NEAR(on_hyperbola(-300e6), line, 5e-4 * line) << "far away it is the line";
}

TEST(ConcreteLink, with_a_hyperbola_bears_no_shear_while_it_is_torn) {
  ConcreteLink l = law();
  l.hyperbolic = 1.0;
  LinkState<double> state{};
  Pair pair;
  double spent = 0.0;
  slide(l, state, pair, 0.0, 1e-6, spent);
  EXPECT_GT(norm(state.shear), 0.0);
  pull(l, state, pair, 4.0 * onset, 4'000);
  EXPECT_EQ(norm(state.shear), 0.0);
  // Closed to half of the opening at its peak, it bears what its secant leaves of the strength.
  const double health = l.normal_force(link, onset, state.opening) / strength;
  pull(l, state, pair, 0.5 * onset, 1'000);
  const LinkResponse<double> r = slide(l, state, pair, 0.5 * onset, 1e-4, spent);
  EXPECT_NEAR(norm(r.shear), health * on_hyperbola(1.1e6) * area, 1e-9 * strength);
  EXPECT_NEAR(health, (1.0 - 3.0 / 10.0) / 4.0, 1e-3);
}

TEST(ConcreteLink, a_brittle_link_falls_to_friction) {
  const double p = 3.0 * strength, u = -p / stiffness;
  LinkState<double> state{};
  Pair pair;
  double spent = 0.0;
  const LinkResponse<double> r =
      slide(law(1.0), state, pair, u, 40.0 * 5.5e6 * area / (0.18 * stiffness), spent);
  EXPECT_EQ(state.opening, link_broken);
  EXPECT_NEAR(norm(r.shear), p * std::tan(0.6), 1e-9 * p);
}

TEST(ConcreteLink, no_force_ever_leaves_the_strength_surface) {
  for (int direction = 0; direction < 37; ++direction) {
    const double angle = direction * pi / 36.0;
    LinkState<double> state{};
    Pair pair;
    const double speed = 2.0 * rupture / 2'000 / pair.dt;
    for (int i = 0; i < 2'000; ++i) {
      const LinkResponse<double> r = law().response(
          link, pair.move_b({speed * std::cos(angle), speed * std::sin(angle), 0.0}), state);
      const double cohesion = state.opening >= 0.0 ? 5.5e6 * area : 0.0;
      const double slope = state.opening >= 0.0 ? std::tan(0.5) : std::tan(0.6);
      ASSERT_LE(r.normal, strength * (1.0 + 1e-12));
      ASSERT_LE(norm(r.shear), std::max(0.0, cohesion - r.normal * slope) * (1.0 + 1e-12) + 1e-12);
    }
  }
}

TEST(ConcreteLink, moments_are_elastic_up_to_their_limit) {
  LinkState<double> state{};
  Pair pair;
  const double kr = 0.18 * stiffness * radius * radius;
  const double limit = 0.15 * radius * strength;
  const double small = 0.5 * limit / kr;
  LinkResponse<double> r =
      law().response(link, pair.move_b({}, {small / pair.dt, 0.0, 0.0}), state);
  EXPECT_NEAR(r.moment.x, -kr * small, 1e-9 * limit);  // twist; the moment on b resists its turn
  EXPECT_EQ(r.yielded, 0.0);
  for (int i = 0; i < 10; ++i)
    r = law().response(link, pair.move_b({}, {small / pair.dt, 0.0, 0.0}), state);
  EXPECT_NEAR(norm(r.moment), limit, 1e-9 * limit);
  EXPECT_NEAR(r.yielded, limit * small, 1e-6 * limit * small);
}

TEST(ConcreteLink, a_rigid_turn_changes_no_force_and_no_moment) {
  const double third = 1.0 / std::sqrt(3.0);
  for (const Vec3& axis : {Vec3{0.0, 0.0, 1.0}, Vec3{1.0, 0.0, 0.0}, Vec3{third, third, third}}) {
    LinkState<double> state{0.0, {0.0, 300.0, 400.0}, {0.05, 0.1, -0.02}};
    ConcreteLink elastic = law();
    elastic.cohesion = elastic.tensile_strength = 1e12;
    Pair pair;
    pair.b.position.x = length + 0.5 * onset;
    const int steps = 1'000;
    for (int turn = 0; turn < steps; ++turn) {
      const LinkResponse<double> r =
          elastic.response(link, pair.turn(axis, 2.0 * pi / steps), state);
      ASSERT_NEAR(r.normal, 0.5 * strength, 1e-6 * strength);
    }
    // positions round at 1e-16 of the length: 1e-12 of the force of that stretch is all that can be
    // asked
    EXPECT_NEAR(norm(state.shear), 500.0, 1e-12 * 0.18 * stiffness * length);
    EXPECT_NEAR(norm(state.shear - Vec3{0.0, 300.0, 400.0}), 0.0, 500.0 * 1e-8);
    EXPECT_NEAR(norm(state.moment - Vec3{0.05, 0.1, -0.02}), 0.0, 0.11 * 1e-8);
  }
}

TEST(ConcreteLink, swapping_the_ends_reverses_the_force) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto any_vec = [&](double size) {
    return Vec3{size * uniform(random), size * uniform(random), size * uniform(random)};
  };
  LinkState<double> one{}, other{};
  Pair pair, swapped;
  pair.excess = 0.003;
  swapped.excess = -0.003;
  swapped.a.position = pair.b.position;
  swapped.b.position = pair.a.position;
  for (int i = 0; i < 500; ++i) {
    const Vec3 va = any_vec(0.01), wa = any_vec(1.0), vb = any_vec(0.01), wb = any_vec(1.0);
    const LinkResponse<double> p = law().response(link, pair.step(va, wa, vb, wb), one);
    const LinkResponse<double> q = law().response(link, swapped.step(vb, wb, va, wa), other);
    ASSERT_NEAR(p.normal, q.normal, 1e-9 * strength);
    ASSERT_NEAR(norm(p.shear + q.shear), 0.0, 1e-9 * strength);
    ASSERT_NEAR(norm(p.moment + q.moment), 0.0, 1e-9 * strength * radius);
  }
}

TEST(ConcreteLink, what_a_random_path_puts_in_is_stored_or_spent) {
  for (const double hyperbolic : {0.0, 1.0}) {
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    ConcreteLink l = law();
    l.hyperbolic = hyperbolic;
    LinkState<double> state{};
    Pair pair;
    double work = 0.0, spent = 0.0, most = 0.0;
    LinkResponse<double> before{};
    Vec3 velocity{}, spin{};
    for (int i = 0; i < 60'000; ++i) {
      if (i % 300 == 0) {
        velocity = 0.01 * Vec3{normal(random), normal(random), normal(random)} +
                   0.3 / (length * 60.0) * (Vec3{length, 0.0, 0.0} - pair.b.position);
        spin = {normal(random), normal(random), normal(random)};
      }
      const PairMotion<double> m = pair.move_b(velocity, spin);
      const LinkResponse<double> r = l.response(link, m, state);
      const double approach = dot(pair.dt * pair.b.velocity, m.normal);
      work += 0.5 * (before.normal + r.normal) * approach -
              0.5 * dot(before.shear + r.shear, m.slip) -
              0.5 * dot(before.moment + r.moment, m.turn);
      spent += r.slid + r.yielded + r.broke;
      before = r;
      double held = l.stored(link, m.distance - length, state) + spent;
      if (state.opening >= 0.0) held += l.tension(link).spent(state.opening);
      most = std::max(most, held);
      ASSERT_NEAR(work, held, 0.01 * most + 1e-9) << "step " << i;
    }
    EXPECT_GT(spent, 0.0);
  }
}

TEST(ConcreteLink, parted_ends_are_released_for_good) {
  LinkState<double> state{};
  Pair pair;
  pull(law(), state, pair, 1.1 * rupture, 2'000);
  pair.b.position.x = 1.49 * length;
  law().response(link, pair.move_b({}), state);
  EXPECT_EQ(state.opening, link_broken);
  pair.b.position.x = 1.51 * length;
  law().response(link, pair.move_b({}), state);
  EXPECT_EQ(state.opening, link_released);
  pair.b.position.x = 0.9 * length;
  EXPECT_EQ(law().response(link, pair.move_b({}), state).normal, 0.0);
}

TEST(ConcreteLink, arms_that_change_leave_a_known_shear_after_a_closed_path) {
  // Open by u, roll j by a, close, roll back: the arm of b is longer by u/2 on the way out, so K_t
  // a u/2 stays. A property of contact points in the middle of the gap, not of rounding.
  ConcreteLink elastic = law();
  elastic.cohesion = elastic.tensile_strength = 1e12;
  LinkState<double> state{};
  Pair pair;
  const double u = 1e-4, angle = 1e-3, v = u / pair.dt, w = angle / pair.dt;
  elastic.response(link, pair.move_b({v, 0.0, 0.0}), state);
  elastic.response(link, pair.move_b({}, {0.0, 0.0, w}), state);
  elastic.response(link, pair.move_b({-v, 0.0, 0.0}), state);
  elastic.response(link, pair.move_b({}, {0.0, 0.0, -w}), state);
  const double kt = 0.18 * stiffness;
  EXPECT_NEAR(norm(state.shear), kt * angle * u / 2.0, 1e-3 * kt * angle * u);
}

}  // namespace concrete_link_test
}  // namespace breccia::dem
