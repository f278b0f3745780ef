// Spheres on faces of tetrahedra: against closed formulas, what is conserved, rolling.

#include <gtest/gtest.h>

#include "dem/stepping/step.hpp"
#include "physics/coupled/scene.hpp"

namespace breccia::coupled {
namespace contact_test {

using namespace testing;

/// Force of a plane on a sphere.
double force_at(double modulus, double radius, double overlap) {
  const double square = 2.0 * radius * overlap - overlap * overlap;
  return modulus / radius * pi * square * square / (4.0 * radius);
}

// The penalty has Hertz's force at an overlap of 261.3 um, E* = 0.5333 GPa. F o^2 stores F o/3.
TEST(SphereOnFaces, returns_from_a_held_block_with_its_energy) {
  const double radius = 0.02, speed = 1.0, modulus = 8e9 / 15.0, overlap = 261.3e-6;
  const double penalty = 4.0 * modulus / (3.0 * pi * std::sqrt(radius * overlap));
  Scene s;
  held_block(s, {0.1, 0.1, 0.05}, 0.025);
  s.solids.config.materials[0].young = 2.0 * 0.96 * modulus;
  s.balls.material("ball", "grain", 2.0 * 0.96 * modulus, 0.2, 2650.0);
  s.balls.sphere({0.0013, 0.0021, radius + 1e-5}, radius, {0.0, 0.0, -speed});
  s.coupling.stiffness = penalty * radius / modulus;
  s.max_step = 1e-7;
  const auto w = s.world();
  EXPECT_NEAR(w->between.given->laws.data()[0].modulus, penalty * radius, 1.0);
  double most = 0.0, deepest = 0.0;
  while (w->spheres.time < 2e-3) {
    step(w->between);
    const Vec3 force = w->spheres.elements.force.data()[0];
    const double z = dem::testing::state(w->spheres, 0).position.z;
    EXPECT_NEAR(force.x, 0.0, 1e-11 * (1.0 + force.z));
    const double expected = z < radius ? force_at(penalty * radius, radius, radius - z) : 0.0;
    EXPECT_NEAR(force.z, expected, 1e-9 * force.z);
    most = std::max(most, force.z);
    deepest = std::max(deepest, radius - z);
  }
  EXPECT_NEAR(deepest, 1.0627 * overlap, 0.01 * overlap);
  EXPECT_NEAR(most, 479.7, 0.01 * 479.7);
  EXPECT_NEAR(dem::testing::state(w->spheres, 0).velocity.z, speed, 1e-4 * speed);
  const EnergyBalance e = energies(*w);
  EXPECT_NEAR(e.missing(), 0.0, 1e-9 * e.start);
}

// Forces of spheres that are evaluated anew between two steps get those of the faces back.
TEST(SphereOnFaces, press_again_with_what_they_pressed) {
  const double radius = 0.02;
  Scene s;
  held_block(s, {0.1, 0.1, 0.05}, 0.025);
  s.balls.material("ball", "grain", 30e9, 0.2, 2650.0);
  s.balls.sphere({0.0013, 0.0021, radius - 1e-6}, radius, {0.0, 0.0, -0.1});
  s.max_step = 1e-7;
  const auto w = s.world();
  step(w->between);
  const Vec3 pressed = w->spheres.elements.force.data()[0];
  const double critical = w->spheres.critical.data()[0];
  EXPECT_GT(pressed.z, 0.0);
  dem::evaluate_anew(w->spheres);
  EXPECT_EQ(w->spheres.elements.force.data()[0].z, 0.0);
  press_spheres_again(w->between);
  EXPECT_EQ(w->spheres.elements.force.data()[0].z, pressed.z);
  EXPECT_EQ(w->spheres.critical.data()[0], critical);
}

// Edges between faces are not felt: a ball that rolls goes on at its speed and its height.
TEST(SphereOnFaces, rolls_over_edges_without_a_jump) {
  const double radius = 0.1, speed = 0.5;
  Scene s;
  held_block(s, {0.6, 0.4, 0.1}, 0.1);
  s.solids.config.materials[0].young = 30e6;  // as long steps as the ball allows
  s.balls.material("ball", "grain", 30e9, 0.2, 2400.0);
  s.coupling.stiffness = 1.0;
  s.coupling.friction = 10.0;
  s.gravity = {0.0, 0.0, -10.0};
  const double mass = 4.0 / 3.0 * pi * radius * radius * radius * 2400.0;
  const double modulus = 30e6 / 0.96 / (1.0 + 1e-3);
  double overlap = 1e-4;
  for (int k = 0; k < 50; ++k)
    overlap *= std::sqrt(10.0 * mass / force_at(modulus, radius, overlap));
  // It rolls about the plane, which is nearer to its centre than its radius.
  s.balls.sphere({-0.15, 0.013, radius - overlap}, radius, {speed, 0.1, 0.0},
                 {-0.1 / (radius - overlap), speed / (radius - overlap), 0.0});
  s.max_step = 1e-4;
  const auto w = s.world();
  const double begin = dem::testing::state(w->spheres, 0).position.z;
  while (w->spheres.time < 0.5) {
    step(w->between);
    const dem::ElementState& b = dem::testing::state(w->spheres, 0);
    ASSERT_NEAR(b.position.z, begin, 1e-9);
    ASSERT_NEAR(b.velocity.x, speed, 1e-6 * speed);
    ASSERT_NEAR(b.velocity.y, 0.1, 1e-6 * speed);
    ASSERT_NEAR(b.spin.z, 0.0, 1e-9);
  }
  EXPECT_GT(dem::testing::state(w->spheres, 0).position.x, 0.08);
  EXPECT_NEAR(energies(*w).friction, 0.0, 1e-9 * energies(*w).start);
}

// Coulomb: it slides on, and slows by mu g.
TEST(SphereOnFaces, slides_and_begins_to_roll) {
  const double radius = 0.05, speed = 1.0, friction = 0.2;
  Scene s;
  held_block(s, {1.2, 0.3, 0.1}, 0.1);
  s.solids.config.materials[0].young = 30e6;
  s.balls.material("ball", "grain", 30e9, 0.2, 2400.0);
  s.coupling.stiffness = 1.0;
  s.coupling.friction = friction;
  s.gravity = {0.0, 0.0, -10.0};
  const double mass = 4.0 / 3.0 * pi * radius * radius * radius * 2400.0;
  double overlap = 1e-4;
  for (int k = 0; k < 50; ++k)
    overlap *= std::sqrt(10.0 * mass / force_at(30e6 / 0.96 / (1.0 + 1e-3), radius, overlap));
  s.balls.sphere({-0.4, 0.01, radius - overlap}, radius, {speed, 0.0, 0.0});
  s.max_step = 2e-5;
  const auto w = s.world();
  // It rolls on the plane, r = R - o below its centre: when v - mu g t = w r, w = mu g r t m/I.
  // Rolling begins at k/(1 + k) v/(mu g), k = I/(m r^2), with 1/(1 + k) of its speed.
  const double k = 0.4 * radius * radius / ((radius - overlap) * (radius - overlap));
  const double lost = k / (1.0 + k), rolls_at = lost * speed / (friction * 10.0);
  while (w->spheres.time < 0.5 * rolls_at) step(w->between);
  EXPECT_NEAR(dem::testing::state(w->spheres, 0).velocity.x, speed * (1.0 - 0.5 * lost),
              1e-3 * speed);
  while (w->spheres.time < 1.5 * rolls_at) step(w->between);
  EXPECT_NEAR(dem::testing::state(w->spheres, 0).velocity.x, (1.0 - lost) * speed, 1e-3 * speed);
  const EnergyBalance e = energies(*w);
  EXPECT_NEAR(e.friction, lost * 0.5 * mass * speed * speed, 3e-3 * e.friction);
  EXPECT_NEAR(e.missing(), 0.0, 1e-9 * e.start);
}

/// A box of tetrahedra that flies, turned, into spheres that nothing holds.
Scene collision() {
  Scene s;
  s.solids.material(10e9, 0.2, 2400.0);
  const Vec3 axis{0.0, 0.38, 0.1};
  s.solids.body("box", fdem3::testing::box({}, {0.1, 0.08, 0.06}, 0.03), {30.0, 0.0, -20.0},
                [&](const Vec3& x) {
                  const Quaternion q = rotated(Quaternion{}, axis);
                  return turned(q, x);
                });
  s.balls.material("ball", "grain", 10e9, 0.2, 2400.0);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      s.balls.sphere({0.085 + 0.001 * j, -0.06 + 0.041 * i, -0.085 + 0.041 * j}, 0.02, {},
                     {0.0, 30.0, 0.0});
  s.coupling.friction = 0.4;
  return s;
}

TEST(SphereOnFaces, keeps_momentum_and_energy_when_bodies_meet) {
  double error[2];
  for (int finer = 0; finer < 2; ++finer) {
    Scene s = collision();
    s.safety = finer == 1 ? 0.1 : 0.4;
    const auto w = s.world();
    const dem::testing::Momentum before = momentum(*w);
    double touched = 0.0;
    while (w->spheres.time < 1.2e-3) {
      step(w->between);
      touched = std::max(touched, count(w->between).touching);
    }
    EXPECT_GT(touched, 1.0);
    const dem::testing::Momentum after = momentum(*w);
    const double size = norm(before.linear);
    EXPECT_LT(norm(after.linear - before.linear), 1e-12 * size);
    EXPECT_LT(norm(after.angular - before.angular), 1e-12 * size);
    const EnergyBalance e = energies(*w);
    EXPECT_GT(e.friction, 1e-3 * e.start);
    error[finer] = std::abs(e.missing()) / e.start;
  }
  EXPECT_LT(error[0], 1e-6);
  EXPECT_LT(error[1], 0.2 * error[0]);
}

// Contact loses nothing but friction: the rest is an error of the step, and falls with it.
TEST(SphereOnFaces, loses_less_the_finer_the_step) {
  double lost[2];
  for (int finer = 0; finer < 2; ++finer) {
    Scene s = collision();
    s.coupling.friction = 0.0;
    s.safety = finer == 1 ? 0.1 : 0.4;
    const auto w = s.world();
    while (w->spheres.time < 1.2e-3) step(w->between);
    const EnergyBalance e = energies(*w);
    lost[finer] = std::abs(e.contact) / e.start;
  }
  EXPECT_LT(lost[1], 0.2 * lost[0] + 1e-9);
  EXPECT_LT(lost[0], 1e-3);
}

/// A cube with joints that has fallen on loose spheres.
std::unique_ptr<Both> fallen_cube(double speed, double safety) {
  Scene s;
  s.solids = fdem3::testing::meeting_cubes();
  fdem3::MaterialConfig& m = s.solids.config.materials[0];
  m.joint.friction_angle = 0.61;
  s.solids.model = {};
  s.solids.body("cube", fdem3::testing::box({0.0, 0.0, 0.0101}, {0.02, 0.02, 0.02}, 0.007),
                {1.0, 0.0, -speed});
  s.balls.material("ball", "grain", 30e9, 0.2, 2400.0);
  for (int i = -1; i < 2; ++i)
    for (int j = -1; j < 2; ++j) s.balls.sphere({0.0105 * i, 0.0105 * j, -0.005}, 0.005, {});
  s.coupling.friction = 0.5;
  s.safety = safety;
  auto w = s.world();
  while (w->spheres.time < 4e-5) step(w->between);
  EXPECT_GT(fdem3::cracks(w->tetrahedra).size(), 50U);
  return w;
}
double missing(Both& w) {
  const EnergyBalance e = energies(w);
  return std::abs(e.missing()) / e.start;
}

TEST(SphereOnFaces, books_every_joule_of_a_cube_that_shatters) {
  for (const double speed : {10.0, 30.0, 60.0}) {
    const auto coarse = fallen_cube(speed, 0.7), fine = fallen_cube(speed, 0.35);
    EXPECT_LT(missing(*coarse), 1e-3) << speed;
    EXPECT_LT(missing(*fine), 0.5 * missing(*coarse) + 1e-6) << speed;
    // Joints that break within a sphere give it nothing: what its faces hold is never below zero.
    const Energies held_between = held(fine->between);
    const double start = energies(*fine).start;
    EXPECT_GT(held_between.elastic.value(), -1e-5 * start) << speed;
    EXPECT_LT(std::abs((held_between.contact + fine->between.ledger.contact).value()), 5e-5 * start)
        << speed;
  }
}

TEST(SphereOnFaces, has_one_clock_and_a_stable_step) {
  Scene s = collision();
  const auto w = s.world();
  for (int k = 0; k < 300; ++k) {
    step(w->between);
    ASSERT_EQ(w->spheres.time, w->tetrahedra.time);
    ASSERT_EQ(w->spheres.next_dt, w->tetrahedra.next_dt);
    ASSERT_EQ(w->spheres.step, w->tetrahedra.step);
  }
}

}  // namespace contact_test
}  // namespace breccia::coupled
