// Walls with mass: they fall, are pushed and hit as closed answers say, and the ledger closes.

#include <gtest/gtest.h>

#include "dem/observe.hpp"
#include "dem/setup/stages.hpp"
#include "dem/setup/walls.hpp"
#include "exec/error.hpp"
#include "physics/dem/scene.hpp"
#include "prepare/checks/check_case.hpp"

namespace breccia::dem {
namespace free_walls_test {

using testing::Scene;
using testing::state;
using testing::velocity_now;

double read(const World& w, const char* quantity) {
  ProbeConfig probe;
  probe.name = probe.on = "wall";
  probe.quantity = quantity;
  return dem::probe(w, probe);
}

/// A ball of 0.01 m, above a plane with mass that faces it.
Scene ball_above(double mass, const Vec3& ball_velocity, double gap = 1e-4) {
  Scene s;
  s.material("ball", "grain", 1e9, 0.2, 2500.0);
  s.config.contact.friction = 0.0;
  s.config.time.safety = 0.05;
  s.sphere({0.0, 0.0, 0.01 + gap}, 0.01, ball_velocity);
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  s.config.walls[0].mass = mass;
  return s;
}
double mass_of_ball() {
  return 4.0 / 3.0 * pi * 1e-6 * 2500.0;
}

/// Momentum and energy decide the velocities after a hit without loss.
TEST(FreeWalls, share_momentum_and_energy_with_a_ball_that_hits_them) {
  const double m = mass_of_ball(), v = -1.5;
  for (const bool hertz : {false, true})
    for (const double ratio : {0.05, 1.0, 7.0}) {
      Scene s = ball_above(ratio * m, {0.0, 0.0, v});
      if (hertz) s.config.contact.law = "hertz";
      World w = s.world();
      double missed = 0.0, pushed = 0.0;
      while (w.time < 5e-3) {
        step(w);
        missed = std::max(missed, balance(w).error_relative);
        pushed = std::max(pushed, -read(w, "force_z"));
        const double all = m * velocity_now(w, 0).z + read(w, "momentum_z");
        ASSERT_NEAR(all, m * v, 1e-12 * m) << w.step;
      }
      EXPECT_GT(pushed, 0.0);
      EXPECT_NEAR(state(w, 0).velocity.z, v * (1.0 - ratio) / (1.0 + ratio), 2e-3) << ratio;
      EXPECT_NEAR(read(w, "velocity_z"), v * 2.0 / (1.0 + ratio), 2e-3) << ratio;
      EXPECT_NEAR(read(w, "kinetic"), 2.0 * ratio * m * v * v / ((1.0 + ratio) * (1.0 + ratio)),
                  4e-3 * m * v * v);
      EXPECT_LT(missed, 1e-2) << ratio << hertz;
      EXPECT_EQ(balance(w).work, 0.0);
      EXPECT_LT(balance(w).error_relative, 2e-3);
    }
}

/// A wall of 3 kg thrown at a ball at rest: what it loses, the ball gains.
TEST(FreeWalls, that_are_thrown_lose_what_they_give) {
  const double m = mass_of_ball(), mass = 3.0 * m;
  Scene s = ball_above(mass, {});
  s.config.walls[0].velocity = {0.0, 0.0, 2.0};
  World w = s.world();
  EXPECT_EQ(read(w, "velocity_z"), 2.0);
  EXPECT_NEAR(balance(w).start, 0.5 * mass * 4.0, 1e-12);
  while (w.time < 5e-3) step(w);
  EXPECT_NEAR(read(w, "velocity_z"), 2.0 * (mass - m) / (mass + m), 4e-3);
  EXPECT_NEAR(state(w, 0).velocity.z, 4.0 * mass / (mass + m), 4e-3);
}

/// The dashpot goes by the mass of both, so the coefficient of restitution is what the case asks.
TEST(FreeWalls, bounce_with_the_restitution_that_is_asked_for) {
  const double m = mass_of_ball();
  for (const double ratio : {0.1, 1.0, 10.0}) {
    Scene s = ball_above(ratio * m, {0.0, 0.0, -1.0});
    s.config.contact.restitution = 0.6;
    s.config.time.safety = 0.01;
    World w = s.world();
    while (w.time < 5e-3) step(w);
    EXPECT_NEAR(state(w, 0).velocity.z - read(w, "velocity_z"), 0.6, 0.004) << ratio;
  }
}

/// Constant forces: x = F t^2 / 2 m for any steps, and a weight falls as any other.
TEST(FreeWalls, accelerate_by_their_force_over_their_mass) {
  Scene s = ball_above(4.0, {}, 1.0);
  s.config.gravity = {0.0, 0.0, -10.0};
  s.config.walls[0].force = {8.0, 3.0, 60.0};
  World w = s.world();
  while (w.time < 0.02) step(w);
  const double a = 60.0 / 4.0 - 10.0;
  EXPECT_NEAR(read(w, "velocity_z"), a * w.time, 1e-12);
  EXPECT_NEAR(read(w, "displacement_z"), 0.5 * a * w.time * w.time, 1e-13);
  EXPECT_EQ(read(w, "velocity_x"), 0.0);
  const EnergyBalance e = balance(w);
  // The scheme's kinetic energy is that of a step's two ends, dt^2 a^2 m / 8 less after rest.
  EXPECT_LT(e.error_relative, 0.5 * w.last_dt * w.last_dt / (w.time * w.time));
  EXPECT_GT(e.work, 0.5 * 4.0 * a * a * w.time * w.time);  // and the ball falls
}

TEST(FreeWalls, move_in_the_directions_that_are_free) {
  Scene s = ball_above(4.0, {}, 1.0);
  s.config.walls[0].force = {8.0, 3.0, 60.0};
  s.config.walls[0].free = {"x", "y"};
  World w = s.world();
  while (w.time < 0.01) step(w);
  EXPECT_NEAR(read(w, "velocity_x"), 2.0 * w.time, 1e-12);
  EXPECT_NEAR(read(w, "velocity_y"), 0.75 * w.time, 1e-12);
  EXPECT_EQ(read(w, "velocity_z"), 0.0);
  s.config.walls[0].free = {};
  s.config.walls[0].shape = "sphere";
  s.config.walls[0].radius = 0.05;
  World ball = s.world();
  while (ball.time < 0.01) step(ball);
  EXPECT_NEAR(read(ball, "velocity_x"), 2.0 * ball.time, 1e-12);
  EXPECT_NEAR(read(ball, "velocity_z"), 15.0 * ball.time, 1e-12);
}

/// F = F0 t / T: the velocity is F0 T / 2 m when t = T, to the second order of the step.
TEST(FreeWalls, follow_a_table_of_their_force) {
  Scene s = ball_above(4.0, {}, 1.0);
  s.config.walls[0].force.times = {0.0, 0.01};
  s.config.walls[0].force.values = {{0.0, 0.0, 0.0}, {0.0, 0.0, 100.0}};
  World w = s.world();
  while (w.time < 0.02) step(w);
  const double expected = 100.0 / 4.0 * (0.005 + w.time - 0.01);
  EXPECT_NEAR(read(w, "velocity_z"), expected, 1e-5 * expected);
  EXPECT_LT(balance(w).error_relative, 1e-12);
}

/// A light plate that is pressed on four balls: its mass over their stiffness rules the step, and
/// at rest they bear its force and its weight.
TEST(FreeWalls, that_are_light_stay_stable) {
  Scene s;
  s.material("ball", "grain", 1e8, 0.2, 2500.0);
  s.config.local_damping = 0.5;
  s.config.contact.restitution = 0.3;
  for (const double x : {-0.03, 0.03})
    for (const double y : {-0.03, 0.03}) s.sphere({x, y, 0.01}, 0.01);
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  s.config.walls[0].name = "floor";
  s.wall({0.0, 0.0, 0.0201}, {0.0, 0.0, -1.0});
  s.config.walls[1].mass = 0.02 * mass_of_ball();
  s.config.walls[1].force = {0.0, 0.0, -50.0};
  s.config.gravity = {0.0, 0.0, -10.0};
  World w = s.world();
  while (w.time < 0.05) {
    step(w);
    const double error = balance(w).error_relative;
    ASSERT_TRUE(w.time < 2e-5 || error < 5e-2) << w.step << " " << error;  // a hit of four steps
  }
  EXPECT_NEAR(read(w, "force_z"), 50.0 + 10.0 * s.config.walls[1].mass, 1e-3);
  EXPECT_LT(std::abs(read(w, "velocity_z")), 1e-6);
}

/// Told by a stage, a force ends, and the wall goes on with the velocity that it has.
TEST(FreeWalls, keep_their_velocity_where_a_stage_takes_their_force) {
  Config config = ball_above(4.0, {}, 1.0).config;
  config.walls[0].velocity = {0.0, 0.0, 2.0};
  config.walls[0].force = {0.0, 0.0, 7.0};
  config.stages.resize(2);
  config.stages[1].walls.resize(1);
  config.stages[1].walls[0].name = "wall";
  StageProgress second;
  second.index = 1;
  const Config now = config_at(config, second);
  EXPECT_EQ(now.walls[0].velocity.value.z, 2.0);
  EXPECT_EQ(now.walls[0].force.value.z, 0.0);
}

std::string said(const Config& config) {
  try {
    check_case(config);
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

TEST(FreeWalls, refuse_what_goes_against_a_mass) {
  const auto expect = [](const char* text, const auto& change) {
    Config config = ball_above(4.0, {}, 1.0).config;
    change(config.walls[0], config);
    EXPECT_NE(said(config).find(text), std::string::npos) << text << "\n" << said(config);
  };
  expect("wall.wall.velocity: a wall with mass moves by the forces on it", [](auto& w, auto&) {
    w.velocity.times = {0.0, 1.0};
    w.velocity.values = {{}, {0.0, 0.0, 1.0}};
  });
  expect("wall.wall.velocity leads where free does not let the wall go", [](auto& w, auto&) {
    w.velocity = {1.0, 0.0, 1.0};
  });
  expect("wall.wall.servo: a wall with mass", [](auto& w, auto&) { w.servo.speed = 1.0; });
  expect("wall.wall.spin: a wall with mass turns only", [](auto& w, auto&) {
    w.spin = {0.0, 0.0, 1.0};
  });
  expect("wall.wall.free: \"up\" is no direction", [](auto& w, auto&) { w.free = {"up"}; });
  expect("wall.wall.free: normal stands alone", [](auto& w, auto&) { w.free = {"normal", "x"}; });
  expect("wall.wall.free is for a wall with mass", [](auto& w, auto&) {
    w.mass = no_limit;
    w.free = {"x"};
  });
  expect("wall.wall.force acts on a wall with mass", [](auto& w, auto&) {
    w.mass = no_limit;
    w.force = {1.0, 0.0, 0.0};
  });
  expect("stage.push.wall.wall: a wall with mass moves by the forces on it",
         [](auto&, Config& config) {
           config.stages.resize(1);
           config.stages[0].name = "push";
           config.stages[0].walls.resize(1);
           config.stages[0].walls[0].name = "wall";
           config.stages[0].walls[0].velocity = {0.0, 0.0, 1.0};
         });
  expect("probe.p.quantity = \"kinetic\" is of walls with mass", [](auto& w, Config& config) {
    w.mass = no_limit;
    ProbeConfig p;
    p.name = "p";
    p.on = "wall";
    p.quantity = "kinetic";
    config.probes = {p};
  });
  expect("wall.wall begins with a velocity", [](auto& w, Config& config) {
    w.velocity = {0.0, 0.0, 1.0};
    config.time.mass_scaling = 10.0;
  });
}

}  // namespace free_walls_test
}  // namespace breccia::dem
