// Damped links: what the branch beside the springs takes, where it acts, and its energy.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dem/setup/materials.hpp"
#include "math/constants.hpp"
#include "pair_driver.hpp"

namespace breccia::dem {
namespace damping_branch_test {

using testing::Pair;

constexpr double length = 0.02, stiffness = 2e8, area = 3e-4, radius = 0.01;
const LinkConstants<double> link{length, stiffness, area, radius, 2.0 * radius};

MaterialConfig concrete(double strength) {
  MaterialConfig m;
  m.tensile_strength = strength;
  m.cohesion = 2.5 * strength;
  m.rolling_limit = 0.5;
  m.link_damping = 0.4;
  m.link_damping_time = 0.25;
  return m;
}
ConcreteLink law(double strength = 1e15) {
  return concrete_law(concrete(strength), {});
}
/// tau  [s]
double relaxation() {
  const MaterialConfig m = concrete(1.0);
  return m.link_damping_time * length / std::sqrt(m.young / m.density);
}

/// What is taken in a cycle u = u_0 sin(w t), after some cycles.  [J]
double taken_in_a_cycle(const Vec3& way, double omega) {
  const ConcreteLink l = law();
  const int steps = 2000;
  Pair pair;
  pair.dt = 2.0 * pi / (omega * steps);
  LinkState<double> state{};
  double taken = 0.0;
  for (int cycle = 0; cycle < 6; ++cycle) {
    taken = 0.0;
    for (int k = 0; k < steps; ++k) {
      const double step = std::sin(2.0 * pi * (k + 1) / steps) - std::sin(2.0 * pi * k / steps);
      taken += l.response(link, pair.move_b((step / pair.dt) * way), state).damped;
    }
  }
  return taken;
}

TEST(DampingBranch, takes_of_a_vibration_what_a_spring_and_a_dashpot_in_line_take) {
  const double size = 1e-7;  // [m]
  for (const double x : {0.1, 1.0, 5.0}) {
    const double loss = pi * 0.4 * x / (1.0 + x * x) * size * size;
    const double omega = x / relaxation(), kt = law().shear_ratio * stiffness;
    EXPECT_NEAR(taken_in_a_cycle({size, 0.0, 0.0}, omega), stiffness * loss,
                0.002 * stiffness * loss)
        << x;
    EXPECT_NEAR(taken_in_a_cycle({0.0, size, 0.0}, omega), kt * loss, 0.002 * kt * loss) << x;
  }
}

TEST(DampingBranch, bears_of_a_steady_stretch_what_its_dashpot_bears) {
  const ConcreteLink l = law();
  Pair pair;
  pair.dt = 0.05 * relaxation();
  LinkState<double> state{};
  LinkResponse<double> r{};
  double u = 0.0;
  const double speed = 1e-3;
  for (int k = 0; k < 400; ++k) {
    r = l.response(link, pair.move_b({speed, 0.0, 0.0}), state);
    u += pair.dt * speed;
  }
  EXPECT_NEAR(r.normal - stiffness * u, 0.4 * stiffness * relaxation() * speed,
              1e-6 * 0.4 * stiffness * relaxation() * speed);
  EXPECT_DOUBLE_EQ(r.active, 1.4);  // the stable step is that of both springs
}

TEST(DampingBranch, leaves_a_crack_to_open_freely_and_acts_again_where_it_is_pressed) {
  const ConcreteLink l = law(2e6);
  const double onset = 2e6 * area / stiffness;
  Pair pair;
  pair.dt = 0.05 * relaxation();
  LinkState<double> state{};
  const auto move = [&](double by, int steps) {
    LinkResponse<double> r{};
    for (int k = 0; k < steps; ++k)
      r = l.response(link, pair.move_b({by / steps / pair.dt, 0.0, 0.0}), state);
    return r;
  };
  move(0.9 * onset, 50);
  EXPECT_GT(state.branch.normal, 0.0);
  move(0.3 * onset, 50);
  EXPECT_EQ(state.branch.normal, 0.0);  // softened and stretched
  EXPECT_GT(state.opening, onset);
  move(-1.5 * onset, 50);
  EXPECT_LT(state.branch.normal, 0.0);  // softened and pressed
}

TEST(DampingBranch, draws_the_ends_of_a_broken_link_not_together) {
  const ConcreteLink l = law(2e6);
  Pair pair;
  pair.dt = 0.05 * relaxation();
  LinkState<double> state{link_broken, {}, {}};
  const double pressed = 1e-7;
  LinkResponse<double> r = l.response(link, pair.move_b({-pressed / pair.dt, 0.0, 0.0}), state);
  EXPECT_LT(r.normal, -1.2 * stiffness * pressed);  // spring and branch
  for (int k = 0; k < 200; ++k) r = l.response(link, pair.move_b({}), state);
  EXPECT_NEAR(r.normal, -stiffness * pressed, 1e-3 * stiffness * pressed);
  for (int k = 0; k < 20; ++k) {  // apart, faster than the branch relaxes
    r = l.response(link, pair.move_b({0.1 * pressed / pair.dt, 0.0, 0.0}), state);
    ASSERT_LE(r.normal, 0.0);
  }
  EXPECT_EQ(state.branch.normal, 0.0);
}

/// Tiles leave out the law of such links, so that it must do what they do, signs of zeros included.
TEST(DampingBranch, and_springs_of_a_broken_link_whose_ends_are_apart_keep_nothing) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const ConcreteLink l = law(2e6);
  Pair pair;
  LinkState<double> state{link_broken, {}, {}};
  const auto is_idle = [&](double distance) {
    return l.is_idle<concrete_all>(link, distance, state);
  };
  l.response(link, pair.move_b({-0.1, 0.3, 0.0}), state);
  EXPECT_FALSE(is_idle(pair.b.position.x));  // pressed
  EXPECT_FALSE(is_idle(1.1 * length));       // it has borne something
  const LinkResponse<double> last = l.response(link, pair.move_b({1e3, 0.0, 0.0}), state);
  EXPECT_NE(last.slid, 0.0);
  int steps = 0;
  while (state.opening > link_released && ++steps < 1000) {
    const PairMotion<double> m =
        pair.move_b({20.0, normal(random), normal(random)}, {normal(random), 1.0, 2.0});
    ASSERT_TRUE(is_idle(m.distance));
    EXPECT_EQ(l.is_parted(link, m.distance, state.opening), m.distance > 1.5 * length);
    const LinkResponse<double> r = l.response(link, m, state);
    for (const double x : {r.normal, r.active, r.shortened, r.slid, r.yielded, r.broke, r.damped})
      EXPECT_EQ(x, 0.0);
    const BranchForce<double>& branch = state.branch;
    for (const Vec3& v : {r.shear, state.shear, r.moment, state.moment, branch.shear,
                          Vec3{r.normal, branch.normal, 0.0}})
      for (const double x : {v.x, v.y, v.z}) EXPECT_TRUE(x == 0.0 && !std::signbit(x));
  }
  EXPECT_GT(steps, 300);
  EXPECT_LT(steps, 1000);
}

TEST(DampingBranch, takes_what_a_random_path_puts_in_and_nothing_stores_or_spends) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  const ConcreteLink l = law(2.2e6);
  LinkState<double> state{};
  Pair pair;
  pair.dt = 1e-7;
  double work = 0.0, spent = 0.0, damped = 0.0, most = 0.0;
  LinkResponse<double> before{};
  Vec3 velocity{}, spin{};
  for (int i = 0; i < 120'000; ++i) {
    if (i % 300 == 0) {
      velocity = 0.03 * Vec3{normal(random), normal(random), normal(random)} +
                 0.3 / (length * 60.0) * (Vec3{length, 0.0, 0.0} - pair.b.position);
      spin = {normal(random), normal(random), normal(random)};
    }
    const PairMotion<double> m = pair.move_b(velocity, spin);
    const LinkResponse<double> r = l.response(link, m, state);
    work += 0.5 * (before.normal + r.normal) * dot(pair.dt * pair.b.velocity, m.normal) -
            0.5 * dot(before.shear + r.shear, m.slip) - 0.5 * dot(before.moment + r.moment, m.turn);
    spent += r.slid + r.yielded + r.broke;
    damped += r.damped;
    before = r;
    double held = l.stored(link, m.distance - length, state) + spent + damped;
    if (state.opening >= 0.0) held += l.tension(link).spent(state.opening);
    most = std::max(most, held);
    ASSERT_NEAR(work, held, 0.01 * most + 1e-9) << "step " << i;
  }
  EXPECT_GT(damped, 0.0);
  EXPECT_GT(spent, 0.0);
}

TEST(DampingBranch, takes_nothing_of_a_pair_that_turns_as_one) {
  const ConcreteLink l = law();
  Pair pair;
  LinkState<double> state{};
  double damped = 0.0;
  for (int k = 0; k < 2000; ++k)
    damped += l.response(link, pair.turn({0.0, 0.6, 0.8}, 1e-5), state).damped;
  EXPECT_LT(std::abs(damped), 1e-12 * stiffness * length * length);
}

}  // namespace damping_branch_test
}  // namespace breccia::dem
