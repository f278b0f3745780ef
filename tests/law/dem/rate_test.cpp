// Tensile strength over strain rate: the curve, what a link makes of it, its energy.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dem/setup/materials.hpp"
#include "math/constants.hpp"
#include "pair_driver.hpp"

namespace breccia::dem {
namespace rate_test {

using testing::Pair;

constexpr double length = 0.02, stiffness = 2e8, area = 3e-4, radius = 0.01;
const LinkConstants<double> link{length, stiffness, area, radius, 2.0 * radius};
const double onset = 2.2e6 * area / stiffness;  // u_1, static

MaterialConfig concrete(const char* rate, double strength = 30e6) {
  MaterialConfig m;
  m.rate = rate;
  m.rate_strength = strength;
  m.softening = 10.0;
  m.slip_wear = 0.3;
  m.turn_wear = 0.1;
  return m;
}
ConcreteLink law(const char* rate = "malvar_ross") {
  return concrete_law(concrete(rate), {});
}
double factor(const ConcreteLink& l, double strain_rate) {
  return l.rate.factor(strain_rate);
}

TEST(RateCurve, is_that_of_malvar_and_ross) {
  const ConcreteLink l = concrete_law(concrete("malvar_ross", 40e6), {});
  // delta = 1/33; 1e3^delta, 1e6^delta; beta = 10^(6 delta - 2), times 1e7^(1/3) and 1e8^(1/3)
  EXPECT_NEAR(factor(l, 1e-3), std::pow(1e3, 1.0 / 33.0), 1e-12);
  EXPECT_NEAR(factor(l, 1.0), std::pow(1e6, 1.0 / 33.0), 1e-12);
  const double beta = std::pow(10.0, 6.0 / 33.0 - 2.0);
  EXPECT_NEAR(factor(l, 10.0), beta * std::cbrt(1e7), 1e-12);
  EXPECT_NEAR(factor(l, 100.0), beta * std::cbrt(1e8), 1e-11);
  EXPECT_NEAR(factor(l, 100.0), 7.06, 0.01);  // as their paper plots it
  EXPECT_EQ(factor(l, 0.0), 1.0);
  EXPECT_EQ(factor(l, 1e4), factor(l, 160.0));
}

TEST(RateCurve, is_that_of_the_model_code) {
  const ConcreteLink l = law("mc2010");
  EXPECT_NEAR(factor(l, 1.0), std::pow(1e6, 0.018), 1e-12);
  // 0.0062 (1e8)^(1/3), whose constant has two digits
  EXPECT_NEAR(factor(l, 100.0), 0.0062 * std::cbrt(1e8), 0.01 * factor(l, 100.0));
}

/// Pulls b at a strain rate until the link has opened by `stretch`; the largest force.
double pull(const ConcreteLink& l, LinkState<double>& state, Pair& pair, double strain_rate,
            double stretch) {
  double most = 0.0;
  while (norm(pair.b.position - pair.a.position) - length < stretch) {
    const PairMotion<double> m = pair.move_b({strain_rate * length, 0.0, 0.0});
    most = std::max(most, l.response(link, m, state).normal);
  }
  return most;
}

TEST(RatedLink, bears_the_strength_of_its_strain_rate) {
  for (const double strain_rate : {0.1, 1.0, 5.0}) {
    Pair pair;
    pair.dt = 2e-8 / strain_rate;
    LinkState<double> state{};
    const ConcreteLink l = law();
    const double most = pull(l, state, pair, strain_rate, 6.0 * onset);
    // the smoothed rate lags by exp(-t/tau) when the peak comes, at t = strain / rate
    const double strain = most / stiffness / length;
    const double tau = length / l.rate.speed;
    const double smoothed = strain_rate * (1.0 - std::exp(-strain / strain_rate / tau));
    const double expected = factor(l, smoothed) * 2.2e6 * area;
    EXPECT_NEAR(most, expected, 2e-3 * expected) << strain_rate;
    EXPECT_NEAR(state.rate, -factor(l, smoothed), 2e-3 * factor(l, smoothed));
  }
}

TEST(RatedLink, opens_as_far_as_a_slow_one_so_that_its_energy_grows_with_its_strength) {
  Pair pair;
  pair.dt = 1e-8;
  const ConcreteLink l = law();
  LinkState<double> state{};
  LinkResponse<double> r{};
  double work = 0.0, before = 0.0, broke = 0.0;
  while (state.opening >= 0.0) {
    r = l.response(link, pair.move_b({2.0 * length, 0.0, 0.0}), state);
    work += 0.5 * (before + r.normal) * pair.dt * 2.0 * length;
    before = r.normal;
    broke += r.broke;
  }
  const double dynamic = -state.rate;
  EXPECT_GT(dynamic, 1.7);
  EXPECT_NEAR(norm(pair.b.position) - length, 11.0 * onset, 1e-3 * onset);
  EXPECT_NEAR(broke, 0.5 * dynamic * 2.2e6 * area * 11.0 * onset, 1e-9 * broke);
  EXPECT_NEAR(work, broke, 2e-3 * broke);
}

TEST(RatedLink, keeps_its_strength_from_the_peak_on) {
  Pair pair;
  pair.dt = 1e-8;
  const ConcreteLink l = law();
  LinkState<double> state{};
  pull(l, state, pair, 1.0, 3.0 * onset);
  const double held = state.rate;
  ASSERT_LT(held, -1.5);
  pull(l, state, pair, 100.0, 5.0 * onset);
  EXPECT_EQ(state.rate, held);
  const double u = norm(pair.b.position) - length;
  const double peak = -held * 2.2e6 * area, u1 = peak / stiffness;
  const double force = l.response(link, pair.move_b({}), state).normal;
  EXPECT_NEAR(force, peak * (11.0 * onset - u) / (11.0 * onset - u1), 1e-6 * peak);
}

TEST(RatedLink, that_was_stretched_fast_but_not_broken_is_not_damaged_when_slow) {
  Pair pair;
  pair.dt = 1e-8;
  const ConcreteLink l = law();
  LinkState<double> state{};
  pull(l, state, pair, 10.0, 1.5 * onset);  // beyond the static strength
  ASSERT_GT(state.rate, 0.0);
  pair.dt = 1e-4;
  for (int k = 0; k < 100; ++k) l.response(link, pair.move_b({}), state);  // rest
  pair.dt = 1e-8;
  const double force = l.response(link, pair.move_b({}), state).normal;
  EXPECT_NEAR(force, stiffness * (norm(pair.b.position) - length), 1e-9 * force);
  EXPECT_NEAR(state.rate, 0.0, 1e-3);
  pull(l, state, pair, 1e-4, 1.51 * onset);  // slowly on: it has shown this strength, no more
  EXPECT_NEAR(state.rate, -1.5, 0.01);
}

TEST(RatedLink, hears_little_of_waves_that_cross_it_to_and_fro) {
  const ConcreteLink l = law();
  const double crossing = length / std::sqrt(30e9 / 2400.0);
  // 1/s and a wave of 10/s: at most 10 / (omega tau) = 10 / (2 pi 5) of it comes through
  Pair pair;
  pair.dt = crossing / 200.0;
  LinkState<double> state{};
  for (int k = 0; k < 200 * 20; ++k) {
    const double wave = 1.0 + 10.0 * std::sin(2.0 * pi * k / 200.0);
    l.response(link, pair.move_b({wave * length, 0.0, 0.0}), state);
    if (k <= 200 * 18) continue;
    ASSERT_NEAR(state.rate, 1.0, 10.0 / (10.0 * pi) + 0.03);
  }
}

TEST(RatedLink, is_as_strong_as_ever_in_shear_and_pressed) {
  for (const char* rate : {"none", "malvar_ross"}) {
    const ConcreteLink l = law(rate);
    Pair pair;
    LinkState<double> state{};
    double shear = 0.0;
    for (int k = 0; k < 200; ++k)
      shear = std::max(shear, norm(l.response(link, pair.move_b({0.0, 1.0, 0.0}), state).shear));
    EXPECT_NEAR(shear, 5.5e6 * area, 0.02 * 5.5e6 * area) << rate;
  }
}

TEST(RatedLink, spends_what_a_random_path_puts_in) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  const ConcreteLink l = law();
  LinkState<double> state{};
  Pair pair;
  pair.dt = 1e-7;
  double work = 0.0, spent = 0.0, most = 0.0;
  LinkResponse<double> before{};
  Vec3 velocity{}, spin{};
  int held_steps = 0;
  for (int i = 0; i < 120'000; ++i) {
    if (i % 600 == 0) {
      velocity = 0.03 * Vec3{normal(random), normal(random), normal(random)} +
                 0.3 / (length * 60.0) * (Vec3{length, 0.0, 0.0} - pair.b.position);
      spin = {normal(random), normal(random), normal(random)};
    }
    const PairMotion<double> m = pair.move_b(velocity, spin);
    const LinkResponse<double> r = l.response(link, m, state);
    const double approach = dot(pair.dt * pair.b.velocity, m.normal);
    work += 0.5 * (before.normal + r.normal) * approach -
            0.5 * dot(before.shear + r.shear, m.slip) - 0.5 * dot(before.moment + r.moment, m.turn);
    spent += r.slid + r.yielded + r.broke;
    before = r;
    LinkConstants<double> now = link;
    now.factor = l.factor_of(link, state.opening, state.rate);
    double held = l.stored(now, m.distance - length, state) + spent;
    if (state.opening >= 0.0) held += l.tension(now).spent(state.opening);
    if (state.opening >= 0.0 && state.rate < 0.0) ++held_steps;
    most = std::max(most, held);
    ASSERT_NEAR(work, held, 0.01 * most + 1e-9) << "step " << i;
  }
  EXPECT_GT(held_steps, 100);  // softened at a dynamic strength for a while
  EXPECT_GT(spent, 0.0);
}

TEST(RatedLink, switched_off_answers_bit_for_bit_as_before) {
  ConcreteLink off = law("none");
  EXPECT_FALSE(off.rated());
  Pair one, other;
  LinkState<double> state{}, same{};
  ConcreteLink plain = off;
  plain.rate = {};
  for (int k = 0; k < 3000; ++k) {
    const Vec3 v{0.02 * std::sin(0.01 * k), 0.01 * std::cos(0.02 * k), 0.0};
    const auto p = off.response(link, one.move_b(v), state);
    const auto q = plain.response(link, other.move_b(v), same);
    ASSERT_EQ(p.normal, q.normal);
    ASSERT_EQ(state.opening, same.opening);
    ASSERT_EQ(state.rate, 0.0);
  }
}

}  // namespace rate_test
}  // namespace breccia::dem
