// Rock with intrinsic joints is softer than its triangles: by the same numbers in statics and
// waves.

#include "fdem/setup/effective.hpp"

#include <gtest/gtest.h>

#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace effective_test {

using namespace testing;

/// A bar between rollers that takes a pulse of pressure at its left end and absorbs at its right.
Scene bar(double stiffness, const char* plane, double length, double edge) {
  Scene scene;
  MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
  m.joints = stiffness > 0.0 ? "intrinsic" : "none";
  if (stiffness > 0.0) m.joint.stiffness = stiffness;
  m.joint.tension = m.joint.cohesion = 1e12;  // linear
  m.damping = 0.02;
  scene.config.plane = plane;
  scene.body("bar", prepare::crossed_rectangle({{0.5 * length, 0.0}, {length, 4.0 * edge}}, edge));
  scene.support("below", {-far, -far}, {far, -1.999 * edge}, {"y"});
  scene.support("above", {-far, 1.999 * edge}, {far, far}, {"y"});
  return scene;
}

/// A modulus that the first stage gives a material without joints does not change what is told of
/// the material.
TEST(EffectiveRock, is_that_of_the_material_in_any_stage) {
  Scene scene = bar(0.0, "strain", 0.04, 0.01);
  const EffectiveRock given = scene.world().given->rocks[0];
  scene.config.materials[0].young_now = 1e6;
  const EffectiveRock now = scene.world().given->rocks[0];
  EXPECT_EQ(now.young, given.young);
  EXPECT_NEAR(now.fast, given.fast, 1e-9 * given.fast);
  EXPECT_NEAR(now.slow, given.slow, 1e-9 * given.slow);
}

/// Mean velocity along the bar between two places.
double mean_velocity(const World& w, double from, double to) {
  double sum = 0.0, mass = 0.0;
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (const NodeState& n : nodes(w, t).at) {
      if (n.position.x < from || n.position.x > to) continue;
      sum += w.triangles.mass.data()[t] * n.velocity.x;
      mass += w.triangles.mass.data()[t];
    }
  return sum / mass;
}

struct Passage {
  double speed, told;  ///< of the pulse  [m/s]
  double back;         ///< share of its velocity that comes back  [-]
};

/// @param absorbed  impedance of the end over that which set-up gives it
Passage passage(double stiffness, const char* plane, double absorbed = 1.0) {
  constexpr double length = 0.4, edge = 0.0025, pulse = 30e-6;
  Scene scene = bar(stiffness, plane, length, edge);
  LoadConfig& push = scene.load("push", "pressure", {-far, -far}, {1e-6, far});
  push.pressure = 1e6;
  for (int k = 0; k <= 60; ++k) {
    push.history.times.push_back(pulse * k / 60.0);
    push.history.factors.push_back(0.5 * (1.0 - std::cos(2.0 * pi * k / 60.0)));
  }
  HistoryConfig& end = scene.load("end", "absorbing", {length - 1e-6, -far}, {far, far}).history;
  end.times = {0.0};
  end.factors = {absorbed};
  World w = scene.world();
  const double c = w.given->rocks[0].fast;
  // the middle of the pulse passes 0.3 m at 0.3/c + pulse/2
  double top = 0.0, arrival = 0.0, back = 0.0;
  while (w.time < 0.3 / c + pulse) {
    step(w);
    const double v = mean_velocity(w, 0.29, 0.31);
    if (v <= top) continue;
    top = v;
    arrival = w.time;
  }
  while (w.time < (length + 0.3) / c + pulse) {
    step(w);
    if (w.time > (length + 0.05) / c + pulse)
      back = std::max(back, std::abs(mean_velocity(w, 0.19, 0.21)));
  }
  const Passage p{0.3 / (arrival - 0.5 * pulse), c, back / top};
  std::printf("%s, p_f = %g E, %.3f of the impedance: wave %.0f of %.0f m/s, %.3f %% come back\n",
              plane, stiffness, absorbed, p.speed, p.told, 100.0 * p.back);
  return p;
}

/// Less than 0.5 % of a pulse comes back from an edge that absorbs, and 2.6 % with the impedance of
/// the triangles alone; the pulse is as fast as set-up tells.
TEST(FdemEffective, absorbing_edges_take_the_impedance_of_rock_with_its_joints) {
  for (const auto& [stiffness, plane] :
       {std::pair{0.0, "strain"}, {20.0, "strain"}, {5.0, "strain"}, {20.0, "stress"}}) {
    const Passage p = passage(stiffness, plane);
    EXPECT_NEAR(p.speed, p.told, 0.01 * p.told);
    EXPECT_LT(p.back, 0.005);
  }
  EXPECT_GT(passage(20.0, "strain", 3651.0 / 3466.0).back, 0.02);
}

/// A free mesh that is pressed between rollers answers with the modulus that set-up tells.
TEST(FdemEffective, modulus_is_that_of_a_pressed_plate) {
  for (const double stiffness : {20.0, 5.0}) {
    Scene scene;
    MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
    m.joints = "intrinsic";
    m.joint.stiffness = stiffness;
    m.joint.tension = m.joint.cohesion = 1e12;
    m.damping = 0.5;
    scene.config.plane = "stress";
    scene.body("plate", prepare::equilateral_rectangle({{0.0, 0.0}, {0.05, 0.05}}, 2.5e-3));
    scene.support("left", {-far, -far}, {-0.02499, far}, {"x"});
    scene.load("right", "traction", {0.02499, -far}, {far, far}).traction = {1e6, 0.0};
    scene.config.local_damping = 0.3;
    World w = scene.world();
    run_to(w, 4e-4);
    const auto mean = [&w](double low, double high) {
      double sum = 0.0, count = 0.0;
      for (Index t = 0; t < w.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
          const Vec2& p = nodes(w, t).at[k].position;
          if (p.x < low || p.x > high) continue;
          sum += p.x;
          count += 1.0;
        }
      return sum / count;
    };
    const double stretch = (mean(0.0245, 0.026) - 0.025) / 0.05;
    const double young = 1e6 / stretch;
    std::printf("p_f = %g E: E/E_0 %.4f, told %.4f, nu %.4f\n", stiffness, young / 30e9,
                w.given->rocks[0].young / 30e9, w.given->rocks[0].poisson);
    EXPECT_NEAR(young, w.given->rocks[0].young, 0.015 * young);
  }
}

/// The best edge of equilateral triangles lies 0 to 30 degrees off the plane of sigma_1: by edges a
/// mesh bears 1/(0.9135 + 0.0865 sigma_2/sigma_1) of f_t, by the rock's stress what is given.
TEST(FdemEffective, tells_the_strength_of_the_mesh) {
  for (const bool by_rock : {false, true}) {
    Scene scene;
    scene.material(30e9, 0.2, 2500.0).joints = "intrinsic";
    scene.config.joints.criterion = by_rock ? "rock" : "edge";
    scene.body("plate", prepare::equilateral_rectangle({{0.0, 0.0}, {0.05, 0.05}}, 2.5e-3));
    const EffectiveRock rock = scene.world().given->rocks.at(0);
    EXPECT_NEAR(rock.tension, by_rock ? 1.0 : 1.0 / 0.9135, by_rock ? 1e-9 : 3e-3);
    EXPECT_NEAR(rock.splitting, by_rock ? 1.0 : 1.0 / (0.9135 - 3.0 * 0.0865), 0.02);
  }
}

}  // namespace effective_test
}  // namespace breccia::fdem
