// Rock that is weaker along planes.

#include <gtest/gtest.h>

#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace bedding_test {

using testing::far;
using testing::Scene;

/// A strip of squares cut by their diagonals, pulled along y.
Scene pulled(double angle, double strength) {
  Scene s;
  MaterialConfig& m = s.material(30e9, 0.0, 2500.0);
  m.joints = "intrinsic";
  m.joint.tension = 5e6;
  m.joint.cohesion = 20e6;
  m.joint.energy_open = 30.0;
  m.bedding = {angle, strength};
  s.body("strip", prepare::crossed_rectangle({{0.0, 0.0}, {0.02, 0.04}}, 0.005));
  s.config.local_damping = 0.5;
  s.support("foot", {-far, -far}, {far, -0.0199}, {"y"});
  s.support("head", {-far, 0.0199}, {far, far}, {"y"}, {0.0, 0.02});
  return s;
}

/// Edges along the planes have `strength`, those across them all, those at 45 degrees the mean.
TEST(Bedding, weakens_joints_by_their_angle) {
  for (const double angle : {0.0, 0.5 * pi}) {
    const World w = pulled(angle, 0.4).world();
    int along = 0, across = 0, between = 0;
    for (Index i = 0; i < w.joints.size(); ++i) {
      const Index edge = w.joints.edge_a.data()[i];
      const Vec2 line = testing::nodes(w, edge / 3).at[(edge + 1) % 3].position -
                        testing::nodes(w, edge / 3).at[edge % 3].position;
      const bool flat = std::abs(line.y) < 1e-9, upright = std::abs(line.x) < 1e-9;
      const bool weak = angle == 0.0 ? flat : upright;
      const double expected = weak ? 0.4 : flat || upright ? 1.0 : 0.7;
      EXPECT_NEAR(w.joints.strength.data()[i], expected, 1e-7);
      (weak ? along : flat || upright ? across : between) += 1;
    }
    EXPECT_GT(along, 0);
    EXPECT_GT(across, 0);
    EXPECT_GT(between, 0);
  }
}

double peak(double angle) {
  Scene s = pulled(angle, 0.4);
  World w = s.world();
  double most = 0.0;
  while (w.time < 8e-4) {
    for (int k = 0; k < 20; ++k) step(w);
    most = std::max(most, -testing::value(w, "head", "force_y", "sum") / 0.02);
  }
  return most;
}

/// Pulled across its planes it bears 0.4 f_t. With planes along the pull edges across it have f_t;
/// those at 45 degrees have 0.7 f_t and fail first, as the rock near them does: at 0.7 f_t over
/// cos^2 45 / cos^2 35 degrees (rock_failure.hpp).
TEST(Bedding, is_felt_across_its_planes) {
  EXPECT_NEAR(peak(0.0), 0.4 * 5e6, 0.01 * 5e6);
  const double at_45 = 0.7 * std::pow(std::cos(35.0 * pi / 180.0), 2) / 0.5;
  EXPECT_NEAR(peak(0.5 * pi), at_45 * 5e6, 0.01 * 5e6);
}

/// Shale that does not break: E 30, E' 15, G' 5 GPa, nu' 0.15.
MaterialConfig& shale(Scene& s, double angle) {
  MaterialConfig& m = s.material(30e9, 0.2, 2500.0);
  m.bedding = {angle, 1.0, 15e9, 0.15, 5e9};
  return m;
}
double closed_modulus(double angle) {
  const double c = std::cos(angle) * std::cos(angle), n = 1.0 - c;
  return 1.0 / (c * c / 30e9 + n * n / 15e9 + (1.0 / 5e9 - 2.0 * 0.15 / 15e9) * c * n);
}

/// On rollers, where the shear that comes with it is free, a strip has the closed modulus: the
/// stress is alike everywhere.
TEST(Bedding, is_felt_in_the_modulus_of_a_pressed_strip) {
  for (const double from_load : {0.0, 15.0, 30.0, 45.0, 60.0, 90.0}) {
    Scene s;
    shale(s, 0.5 * pi - from_load * pi / 180.0);  // pressed along y
    s.body("strip", prepare::equilateral_rectangle({{0.0, 0.0}, {0.02, 0.04}}, 0.004));
    s.config.local_damping = 0.5;
    s.support("foot", {-far, -far}, {far, -0.01999}, {"y"});
    s.load("head", "pressure", {-far, 0.01999}, {far, far}).pressure = 1e6;
    World w = s.world();
    testing::run_to(w, 8e-4);
    double sum = 0.0, count = 0.0;
    for (Index t = 0; t < w.triangles.size(); ++t)
      for (const NodeState& n : testing::nodes(w, t).at)
        if (n.position.y > 0.0199) sum += n.position.y, count += 1.0;
    const double young = 1e6 * 0.04 / (0.02 - sum / count);
    const double closed = closed_modulus(from_load * pi / 180.0);
    EXPECT_NEAR(young, closed, 1e-3 * closed) << from_load;
  }
}

/// Time that the crest of a pulse takes along a bar.
double pulse_speed(Scene& s, double angle, bool rollers) {
  constexpr double length = 0.4, edge = 0.005, pulse = 40e-6;
  shale(s, angle).damping = 0.02;
  s.body("bar", prepare::crossed_rectangle({{0.5 * length, 0.0}, {length, 2.0 * edge}}, edge));
  if (rollers) {
    s.support("below", {-far, -far}, {far, -0.999 * edge}, {"y"});
    s.support("above", {-far, 0.999 * edge}, {far, far}, {"y"});
  }
  LoadConfig& push = s.load("push", "pressure", {-far, -far}, {1e-6, far});
  push.pressure = 1e5;
  for (int k = 0; k <= 60; ++k) {
    push.history.times.push_back(pulse * k / 60.0);
    push.history.factors.push_back(0.5 * (1.0 - std::cos(2.0 * pi * k / 60.0)));
  }
  World w = s.world();
  double at[2] = {}, top[2] = {};
  while (w.time < 1.6e-4) {
    step(w);
    double sum[2] = {}, count[2] = {};
    for (Index t = 0; t < w.triangles.size(); ++t)
      for (const NodeState& n : testing::nodes(w, t).at)
        for (int k = 0; k < 2; ++k)
          if (std::abs(n.position.x - (k == 0 ? 0.05 : 0.2)) < 0.6 * edge)
            sum[k] += n.velocity.x, count[k] += 1.0;
    for (int k = 0; k < 2; ++k)
      if (sum[k] / count[k] > top[k]) top[k] = sum[k] / count[k], at[k] = w.time;
  }
  return 0.15 / (at[1] - at[0]);
}

/// Between rollers a wave that presses has sqrt(C/rho) of plane strain, along the planes and across
/// them; in a slender bar at any angle sqrt(E(t)/rho) of plane stress.
TEST(Bedding, is_felt_by_waves) {
  const double s11 = (1.0 - 0.04) / 30e9, s22 = 1.0 / 15e9 - 0.0225 * 30e9 / (15e9 * 15e9);
  const double s12 = -0.15 * 1.2 / 15e9, over = 1.0 / (s11 * s22 - s12 * s12);
  for (const bool across : {false, true}) {
    Scene s;
    s.config.plane = "strain";
    const double speed = std::sqrt((across ? s11 : s22) * over / 2500.0);
    EXPECT_NEAR(pulse_speed(s, across ? 0.5 * pi : 0.0, true), speed, 0.01 * speed) << across;
  }
  for (const double angle : {0.0, 30.0, 60.0, 90.0}) {
    Scene s;
    s.config.plane = "stress";
    const double speed = std::sqrt(closed_modulus(angle * pi / 180.0) / 2500.0);
    EXPECT_NEAR(pulse_speed(s, angle * pi / 180.0, false), speed, 0.015 * speed) << angle;
  }
}

/// Rock that fails at f_t on any plane does so however its planes lie: the stress along edges is
/// that of bedded rock.
TEST(Bedding, of_stiffness_leaves_the_tensile_strength) {
  for (const double angle : {0.0, 30.0, 60.0, 90.0}) {
    Scene s = pulled(angle * pi / 180.0, 1.0);
    s.config.materials[0].bedding = {angle * pi / 180.0, 1.0, 15e9, 0.0, 7e9};
    World w = s.world();
    double most = 0.0;
    while (w.time < 1.2e-3) {
      for (int k = 0; k < 20; ++k) step(w);
      most = std::max(most, -testing::value(w, "head", "force_y", "sum") / 0.02);
    }
    EXPECT_NEAR(most, 5e6, 0.02 * 5e6) << angle;
  }
}

}  // namespace bedding_test
}  // namespace breccia::fdem
