// Spheres tied to faces of tetrahedra: objective, the energy of a break, balance.

#include <gtest/gtest.h>

#include "physics/coupled/scene.hpp"

namespace breccia::coupled {
namespace bonds_test {

using namespace testing;

TEST(Bonds, feel_no_rotation_of_both) {
  Quaternion q;
  for (int k = 0; k < 200; ++k) q = rotated(q, {0.01, -0.02, 0.005});
  fdem3::TetrahedronNodes now{};
  const Vec3 corner[4] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.2, 0.9, 0.1}, {0.3, 0.2, -0.8}};
  BallBond bond{};
  const double share[4] = {0.2, 0.3, 0.5, 0.0};
  Vec3 point{};
  for (int k = 0; k < 4; ++k) {
    bond.share[k] = share[k];
    point += share[k] * corner[k];
    now.at[k].position = turned(q, corner[k]) + Vec3{3.0, -2.0, 1.0};
  }
  dem::ElementState ball{};
  const Vec3 centre{0.4, 0.4, 0.5};
  bond.arm = point - centre;
  bond.length = norm(bond.arm);
  ball.position = turned(q, centre) + Vec3{3.0, -2.0, 1.0};
  const BondGap gap = gap_of(bond, ball, q, now);
  EXPECT_NEAR(gap.open, 0.0, 1e-13);
  EXPECT_NEAR(gap.slide, 0.0, 1e-13);
}

BondConfig tie(double strength) {
  BondConfig bond;
  bond.name = "tie";
  bond.spheres = "all";
  bond.tetrahedra = "block";
  bond.tensile_strength = strength;
  bond.cohesion = 4.0 * strength;
  bond.energy_open = 10.0;
  bond.energy_slide = 50.0;
  bond.stiffness = 20.0;
  return bond;
}

// Slowly pulled off, a bond takes G_I and the elastic part of its curve, 2/3 f_t o_p, per area.
TEST(Bonds, take_their_fracture_energy) {
  const double radius = 0.01;
  Scene s;
  held_block(s, {0.06, 0.06, 0.02}, 0.03);
  s.balls.material("ball", "grain", 30e9, 0.2, 2400.0);
  s.balls.sphere({0.012, 0.021, radius}, radius, {0.0, 0.0, 0.05});
  dem::SupportConfig pull;
  pull.name = "pull";
  pull.fix = {"all"};
  pull.velocity = Vec3{0.0, 0.0, 0.05};
  s.balls.config.supports.push_back(pull);
  s.bonds.push_back(tie(3e6));
  s.bonds[0].range = 1.05;  // the one face under it
  s.max_step = 2e-7;
  const auto w = s.world();
  ASSERT_EQ(w->between.bonds.size(), 1);
  const double area = w->between.bonds.tie.data()[0].area;
  EXPECT_NEAR(area, 0.5 * 0.03 * 0.03, 1e-12);
  const double stretch = 2.0 * radius * 3e6 / (20.0 * 30e9);  // o_p
  double most = 0.0;
  while (count(w->between).broken == 0.0 && w->spheres.time < 1e-3) {
    step(w->between);
    most = std::max(most, -w->spheres.elements.force.data()[0].z);
  }
  EXPECT_EQ(count(w->between).broken, 1.0);
  EXPECT_NEAR(most, 3e6 * area, 1e-3 * most);
  step(w->between);
  const EnergyBalance e = energies(*w);
  EXPECT_NEAR(e.fracture, area * (10.0 + 2.0 / 3.0 * 3e6 * stretch), 1e-3 * e.fracture);
  EXPECT_NEAR(e.missing(), 0.0, 1e-9 * e.fracture);
  EXPECT_EQ(norm(w->spheres.elements.force.data()[0]), 0.0);
}

// Balls on a block that flies and turns: they stay on it, and nothing is lost.
TEST(Bonds, keep_momentum_and_energy) {
  Scene s;
  s.solids.material(10e9, 0.2, 2400.0);
  s.solids.body("block", fdem3::testing::box({0.0, 0.0, -0.01}, {0.06, 0.04, 0.02}, 0.02),
                {0.0, 3.0, 1.0});
  s.balls.material("ball", "grain", 10e9, 0.2, 2400.0);
  for (int i = 0; i < 3; ++i)
    s.balls.sphere({-0.02 + 0.02 * i, 0.003, 0.01}, 0.009, {0.2 * i, 3.0, 0.0});
  s.bonds.push_back(tie(50e6));
  s.bonds[0].breaks = false;
  s.safety = 0.3;
  const auto w = s.world();
  const dem::testing::Momentum before = momentum(*w);
  double worst = 0.0;
  while (w->spheres.time < 3e-4) {
    step(w->between);
    const EnergyBalance e = energies(*w);
    worst = std::max(worst, std::abs(e.missing()) / e.start);
  }
  const dem::testing::Momentum after = momentum(*w);
  EXPECT_LT(norm(after.linear - before.linear), 1e-12 * norm(before.linear));
  EXPECT_LT(norm(after.angular - before.angular), 1e-12 * norm(before.linear));
  EXPECT_LT(worst, 1e-4);
  EXPECT_EQ(count(w->between).broken, 0.0);
}

}  // namespace bonds_test
}  // namespace breccia::coupled
