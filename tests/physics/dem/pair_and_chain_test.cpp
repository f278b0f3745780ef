// Pairs and chains of linked spheres against their own discrete dynamics, which is known exactly:
// the leapfrog moves a mode of frequency w as sin(n theta), theta = 2 asin(w dt / 2).

#include <gtest/gtest.h>

#include <functional>

#include "scene.hpp"

namespace breccia::dem {
namespace pair_and_chain_test {

using testing::Scene;
using testing::state;

/// Links that never yield.
Scene elastic_scene(double poisson) {
  Scene s;
  MaterialConfig& m = s.material("c", "concrete", 30e9, poisson, 2400.0);
  m.tensile_strength = m.cohesion = 1e15;
  m.rolling_limit = 1e9;
  s.config.time.safety = 0.5;
  return s;
}

/// A quantity that starts at 0 with the rate `rate`, after n steps of the leapfrog.
double swing(double omega, double dt, double rate, int n) {
  const double theta = 2.0 * std::asin(0.5 * omega * dt);
  return rate * dt / std::sin(theta) * std::sin(n * theta);
}

/// Steps and holds a quantity against the swing of its mode, at every step.
void expect_swing(World w, double omega, double rate, int steps, double tolerance,
                  const std::function<double(const World&)>& read) {
  const double dt = w.next_dt;
  ASSERT_GT(steps * omega * dt, 2.0 * pi) << "less than one period";
  for (int n = 1; n <= steps; ++n) {
    w.next_dt = dt;
    step(w);
    ASSERT_NEAR(read(w), swing(omega, dt, rate, n), tolerance * rate / omega) << "step " << n;
  }
}

/// Two spheres of unequal size, linked; small rates keep them linear.
struct UnequalPair {
  Scene scene = elastic_scene(0.1);
  double kn, kt, kr, arm_a, arm_b, ma, mb, ia, ib;

  UnequalPair() {
    scene.sphere({0.0, 0.0, 0.0}, 0.010);
    scene.sphere({0.025, 0.0, 0.0}, 0.013);
    scene.link(0, 1);
    const World w = scene.world();
    const ConcreteLink& law = w.concrete.groups[0].law;
    kn = w.concrete.stiffness.data()[0];
    kt = law.shear_ratio * kn;
    kr = law.rolling_ratio * kt * 0.0115 * 0.0115;
    arm_a = 0.010 + 0.001;  // the contact point lies in the middle of the gap of 2 mm
    arm_b = 0.013 + 0.001;
    ma = scene.model.mass[0];
    mb = scene.model.mass[1];
    ia = scene.model.inertia[0];
    ib = scene.model.inertia[1];
  }
};

TEST(LinkedPair, of_unequal_spheres_vibrates_along_its_axis_with_the_reduced_mass) {
  UnequalPair p;
  const double v = 1e-4;
  p.scene.model.velocity = {{-v / p.ma * p.mb, 0.0, 0.0}, {v, 0.0, 0.0}};
  const double omega = std::sqrt(p.kn * (1.0 / p.ma + 1.0 / p.mb));
  expect_swing(p.scene.world(), omega, v * (1.0 + p.mb / p.ma), 2000, 1e-6, [](const World& w) {
    return norm(state(w, 1).position - state(w, 0).position) - 0.025;
  });
}

TEST(LinkedPair, of_unequal_spheres_twists_with_the_reduced_inertia) {
  UnequalPair p;
  const double spin = 1e-3;
  p.scene.model.spin = {{-spin * p.ib / p.ia, 0.0, 0.0}, {spin, 0.0, 0.0}};
  const double omega = std::sqrt(p.kr * (1.0 / p.ia + 1.0 / p.ib));
  expect_swing(p.scene.world(), omega, spin * (1.0 + p.ib / p.ia), 2000, 1e-6, [&](const World& w) {
    return -w.concrete.kept.in_double.moment.view()[0].x / p.kr;
  });
}

/// Shear s = u_b - u_a - l_a theta_a - l_b theta_b and bend phi = theta_b - theta_a obey
///   s''   = -K_t P s + K_r Q phi,   P = 1/m_a + 1/m_b + l_a^2/I_a + l_b^2/I_b
///   phi'' =  K_t Q s - K_r R phi,   Q = l_b/I_b - l_a/I_a,  R = 1/I_a + 1/I_b
/// The other two of the four freedoms in the plane move the pair as a rigid body.
TEST(LinkedPair, of_unequal_spheres_has_two_modes_that_mix_shear_and_bending) {
  const UnequalPair base;
  const double P = 1.0 / base.ma + 1.0 / base.mb + base.arm_a * base.arm_a / base.ia +
                   base.arm_b * base.arm_b / base.ib;
  const double Q = base.arm_b / base.ib - base.arm_a / base.ia, R = 1.0 / base.ia + 1.0 / base.ib;
  const double half = 0.5 * (base.kt * P + base.kr * R);
  const double root = std::sqrt(half * half - base.kt * base.kr * (P * R - Q * Q));
  for (const double square : {half - root, half + root}) {
    UnequalPair p;
    const double rate_s = 1e-5, rate_phi = (p.kt * P - square) / (p.kr * Q) * rate_s;
    // The motion of the ends that makes these rates without moving the pair as a whole: momenta
    // that the link itself would give, by a force f on a and a couple c on a.
    const double det = P * R - Q * Q;
    const double f = -(R * rate_s + Q * rate_phi) / det;
    const double c = -(P * rate_phi + Q * rate_s) / det;
    p.scene.model.velocity = {{0.0, f / p.ma, 0.0}, {0.0, -f / p.mb, 0.0}};
    p.scene.model.spin = {{0.0, 0.0, (p.arm_a * f + c) / p.ia},
                          {0.0, 0.0, (p.arm_b * f - c) / p.ib}};
    const double omega = std::sqrt(square);
    expect_swing(p.scene.world(), omega, rate_s, 2000, 1e-6, [&](const World& w) {
      return -w.concrete.kept.in_double.shear.view()[0].y / p.kt;
    });
    expect_swing(p.scene.world(), omega, std::fabs(rate_phi), 2000, 1e-6, [&](const World& w) {
      return -std::copysign(1.0, rate_phi) * w.concrete.kept.in_double.moment.view()[0].z / p.kr;
    });
  }
}

/// A free chain of n touching spheres; its standing waves are u_j = cos(q (j + 1/2)), q = p pi / n.
struct Chain {
  static constexpr int size = 64;
  static constexpr double spacing = 0.02;
  Scene scene = elastic_scene(0.2);

  Chain() {
    for (int j = 0; j < size; ++j) scene.sphere({j * spacing, 0.0, 0.0}, 0.01);
    for (int j = 0; j + 1 < size; ++j) scene.link(j, j + 1);
  }
  static double shape(int mode, int j) { return std::cos(mode * pi / size * (j + 0.5)); }
};

TEST(Chain, every_standing_wave_has_the_frequency_of_the_dispersion_relation) {
  for (const int mode : {1, 2, 5, 16, 32, 48, 63}) {
    Chain chain;
    const double v = 1e-2;
    for (int j = 0; j < Chain::size; ++j)
      chain.scene.model.velocity[static_cast<std::size_t>(j)].x = v * Chain::shape(mode, j);
    World w = chain.scene.world();
    const double k = w.concrete.stiffness.data()[0], m = chain.scene.model.mass[0];
    const double omega = 2.0 * std::sqrt(k / m) * std::sin(0.5 * mode * pi / Chain::size);
    const double dt = w.next_dt;
    const int steps = std::max(500, static_cast<int>(1.5 * 2.0 * pi / (omega * dt)));
    // Axial forces are linear in the positions to rounding, so the whole chain is known.
    for (int n = 1; n <= steps; ++n) {
      step(w);
      ASSERT_EQ(w.last_dt, dt);
      const double now = swing(omega, dt, v, n);
      for (const int j : {0, 7, Chain::size / 2, Chain::size - 1})
        ASSERT_NEAR(state(w, j).position.x - j * Chain::spacing, Chain::shape(mode, j) * now,
                    1e-6 * v / omega)
            << "mode " << mode << ", step " << n << ", element " << j;
    }
  }
}

/// A long chain whose end moves with the constant velocity v from t = 0 on. The transform of the
/// momentum that the others have taken up is m v / s^2 / (e^K - 1), sinh(K / 2) = s / (2 w), with
/// w = sqrt(k / m); its pole at s = 0 gives m v (w t - 1/2), its branch points at s = +-2 i w an
/// oscillation that dies like m v (w t)^(-3/2) / 4.
TEST(Chain, a_pushed_end_gives_momentum_at_the_rate_of_the_wave_speed) {
  Chain chain;
  const double v = 1e-4;
  chain.scene.config.supports.push_back(
      {"push", "", {-1e-3, -1.0, -1.0}, {1e-3, 1.0, 1.0}, {"x"}, {v, 0.0, 0.0}, 0.0});
  World w = chain.scene.world();
  const double k = w.concrete.stiffness.data()[0], m = chain.scene.model.mass[0];
  const double omega = std::sqrt(k / m);  // spacings a second that a long wave runs
  double given = 0.0;
  while (omega * w.time < 0.8 * Chain::size) {
    step(w);
    const double push = -w.elements.force.data()[0].x;
    const double until_now = (given + 0.5 * push * w.last_dt) / (m * v);
    given += push * w.last_dt;
    if (omega * w.time > 10.0) {
      ASSERT_NEAR(until_now, omega * w.time - 0.5, 0.01) << omega * w.time;
    }
  }
}

/// A chain of three whose first link is softened, whose second one is whole.
TEST(Chain, damage_of_elements_counts_links_that_soften_and_those_that_broke) {
  Scene scene = elastic_scene(0.2);
  scene.config.materials[0].tensile_strength = 2e6;
  scene.config.materials[0].softening = 10.0;
  scene.sphere({0.0, 0.0, 0.0}, 0.01, {-1.0, 0.0, 0.0});
  scene.sphere({0.02, 0.0, 0.0}, 0.01);
  scene.sphere({0.04, 0.0, 0.0}, 0.01);
  scene.link(0, 1);
  scene.link(1, 2);
  scene.config.supports.push_back(
      {"left", "", {-1.0, -1.0, -1.0}, {0.005, 1.0, 1.0}, {"x"}, {-1.0, 0.0, 0.0}, 0.0});
  scene.config.supports.push_back(
      {"right", "", {0.015, -1.0, -1.0}, {1.0, 1.0, 1.0}, {"x"}, {}, 0.0});
  World w = scene.world();
  const ConcreteLink& law = w.concrete.groups[0].law;
  const LinkConstants<double> link{0.02, w.concrete.stiffness.data()[0], w.concrete.area.data()[0],
                                   0.01, 0.02};
  const double onset = law.tension(link).onset();
  EXPECT_EQ(damage(w), (std::vector<double>{0.0, 0.0, 0.0}));
  while (link_opening(w.concrete, 0) < 3.0 * onset) step(w);
  const double lost = law.tension(link).damage(link_opening(w.concrete, 0));
  ASSERT_GT(lost, 0.5);
  ASSERT_LT(lost, 0.9);
  std::vector<double> now = damage(w);
  EXPECT_NEAR(now[0], lost, 1e-3);
  EXPECT_NEAR(now[1], 0.5 * lost, 1e-3);
  EXPECT_EQ(now[2], 0.0);
  while (link_opening(w.concrete, 0) >= 0.0) step(w);
  now = damage(w);
  EXPECT_EQ(now[0], 1.0);
  EXPECT_EQ(now[1], 0.5);
}

}  // namespace pair_and_chain_test
}  // namespace breccia::dem
