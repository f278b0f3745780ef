// Losses of joints and couples that store their forces in single precision, and of joints and
// triangles that are computed in it. Forces follow from positions, so no error adds up: each is off
// by 2^-24 = 6e-8 of itself at most where it is stored, by a few times that where it is computed.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "fdem/stepping/step.hpp"
#include "scene.hpp"

namespace breccia::fdem {
namespace fdem_mixed_precision_test {

using testing::Momentum;
using testing::momentum;
using testing::Scene;

constexpr double nearest = 0x1p-24;
constexpr double some = 16 * nearest;  ///< a few operations, one after the other

/// A brittle disc that breaks on a plate; nothing holds the two.
Scene impact(const char* precision) {
  Scene scene;
  MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.friction = 0.5;
  m.joint.tension = 2e6;
  m.joint.cohesion = 6e6;
  m.joint.energy_open = 2.0;
  m.joint.energy_slide = 6.0;
  scene.config.precision = precision;
  scene.config.time.safety = 0.3;
  scene.body("disc", prepare::ringed_disc({0.0, 0.0202}, 0.02, 4e-3), 0, {2.0, -60.0});
  scene.body("plate", prepare::equilateral_rectangle({{0.0, -0.01}, {0.06, 0.02}}, 5e-3));
  return scene;
}

/// A state of double, forces and laws rounded.
World rounded(const World& full, const Scene& scene, Precision precision) {
  World w = full;
  w.exec.precision = w.couples.history.precision = precision;
  const auto round = [](auto& force) {
    force.in_single.resize(force.in_double.size());
    for (Index i = 0; i < force.in_double.size(); ++i)
      force.in_single.data()[i] = converted<float>(force.in_double.data()[i]);
    force.in_double.resize(0);
  };
  round(w.joints.force);
  round(w.couples.history.force);
  configure(w, scene.config);
  return w;
}

TEST(FdemMixedPrecision, forces_of_a_breaking_disc_differ_by_less_than_3e_6_after_a_step) {
  const Scene scene = impact("double");
  World full = scene.world();
  for (int i = 0; i < 600; ++i) step(full);
  ASSERT_GT(cracks(full).size(), 20U);
  World mixed = rounded(full, scene, Precision::mixed),
        single = rounded(full, scene, Precision::single);
  step(full);
  for (World* other : {&mixed, &single}) {
    step(*other);
    std::vector<double> errors;
    for (Index t = 0; t < full.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Vec2 f = full.triangles.force.data()[t].at[k];
        if (norm(f) > 0.0)
          errors.push_back(norm(other->triangles.force.data()[t].at[k] - f) / norm(f));
      }
    std::nth_element(errors.begin(), errors.begin() + static_cast<long>(errors.size() / 2),
                     errors.end());
    const double median = errors[errors.size() / 2];
    std::printf("%s: %.2g\n", word_of(other->exec.precision), median);
    EXPECT_LT(median, 3e-6);
    EXPECT_GT(median, 1e-10);
  }
}

TEST(FdemMixedPrecision, keeps_momentum_and_energy_of_a_breaking_disc) {
  constexpr int steps = 1500;
  std::array<double, 3> missing{}, drift{};
  std::array<std::int64_t, 3> first{};
  const char* const words[] = {"double", "mixed", "single"};
  for (std::size_t p = 0; p < 3; ++p) {
    World w = impact(words[p]).world();
    step(w);
    const Momentum start = momentum(w);
    double impulse = 0.0;  // sum of all forces over time
    for (int i = 0; i < steps; ++i) {
      step(w);
      if (first[p] == 0 && w.exposed.changed.data()[change_broken] != 0) first[p] = w.step;
      for (const Corners& f : w.triangles.force.host())
        for (const Vec2& v : f.at) impulse += w.last_dt * norm(v);
    }
    EXPECT_GT(cracks(w).size(), 20U);
    const Momentum end = momentum(w);
    drift[p] = norm(end.linear - start.linear) / start.size;
    missing[p] = std::fabs(energies(w).balance.error_relative);
    std::printf("%s: momentum %.2g, energy %.5g, first break in step %d\n", words[p], drift[p],
                missing[p], static_cast<int>(first[p]));
    // A couple's six forces are rounded one by one.
    EXPECT_LT(norm(end.linear - start.linear), (p == 0 ? 1e-14 : nearest) * impulse);
  }
  EXPECT_GT(drift[1], drift[0]);
  EXPECT_LT(missing[1], 1.1 * missing[0] + 1e-6);
  EXPECT_LT(missing[2], 1.1 * missing[0] + 1e-6);
  EXPECT_GT(first[0], 0);
  EXPECT_LE(std::abs(first[2] - first[0]), 1);
}

/// Squares of the works of roundings in a step, each of some of its force, which are a walk.
/// [J2/m2]
double works_of_rounding(const World& w) {
  double sum = 0.0;
  const auto speed = [&](Index node) {
    return norm(testing::nodes(w, node / 3).at[node % 3].velocity);
  };
  const auto add = [&](const Vec2& force, Index node) {
    const double work = some * norm(force) * speed(node) * w.last_dt;
    sum += work * work;
  };
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) add(w.triangles.force.data()[t].at[k], 3 * t + k);
  for (Index i = 0; i < w.joints.size(); ++i) {
    const JointEnds& e = w.joint_ends.data()[i];
    const JointForce f = w.exec.precision == Precision::full
                             ? w.joints.force.in_double.data()[i]
                             : converted<double>(w.joints.force.in_single.data()[i]);
    for (const Index node : {e.a0, e.b0}) add(2.0 * f.first, node);  // and of the triangle there
    for (const Index node : {e.a1, e.b1}) add(2.0 * f.second, node);
  }
  return sum;
}

/// Waves run to and fro in a plate that turns: a triangle's three forces add up to
/// nothing, a joint gives both sides the same.
TEST(FdemMixedPrecision, keeps_momentum_of_waves_to_1e_11_and_their_energy_in_single) {
  constexpr int steps = 20'000;
  double error[2];
  for (const bool single : {false, true}) {
    Scene scene;
    MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
    m.joints = "intrinsic";
    m.joint.tension = m.joint.cohesion = 1e9;
    m.joint.energy_open = m.joint.energy_slide = 1e6;
    scene.config.precision = single ? "single" : "double";
    scene.body("plate", prepare::equilateral_rectangle({{1.0, 2.0}, {0.04, 0.02}}, 4e-3), 0,
               {3.0, 1.0});
    World w = scene.world();
    testing::stir(w, [](const Vec2& x) {
      const Vec2 r = x - Vec2{1.0, 2.0};
      return Vec2{3.0 + 2.0 * std::cos(80.0 * r.x) - 60.0 * r.y, 1.0 + 60.0 * r.x};
    });
    begin_ledger(w);
    const Momentum start = momentum(w);
    double squares = 0.0;
    for (int i = 0; i < steps; ++i) {
      step(w);
      squares += works_of_rounding(w);
    }
    const double rounding = 5.0 * std::sqrt(squares);
    const EnergyBalance balance = energies(w).balance;
    error[single ? 1 : 0] = balance.missing();
    const double lost = norm(momentum(w).linear - start.linear) / start.size;
    std::printf("%s: momentum %.2g, energy %.3g of %.3g, rounding at most %.2g J/m\n",
                scene.config.precision.c_str(), lost, balance.missing(), balance.kinetic, rounding);
    EXPECT_LT(lost, 1e-11);
    if (single) {
      EXPECT_LT(std::fabs(error[1] - error[0]), rounding);
    }
  }
}

/// Two triangles that are pulled apart at the joint between them.
struct Pulled {
  double peak = 0.0;   ///< largest force in the joint  [N/m]
  double spent = 0.0;  ///< on its fracture  [J/m]
};
Pulled pulled_apart(const char* precision) {
  Scene scene;
  MaterialConfig& m = scene.material(30e9);
  m.joints = "intrinsic";
  m.joint.tension = 3e6;
  m.joint.cohesion = 15e6;
  m.joint.energy_open = 10.0;
  m.joint.energy_slide = 50.0;
  scene.config.precision = precision;
  prepare::Mesh mesh;
  mesh.point = {{0.0, 0.0}, {1e-3, 0.0}, {0.5e-3, 0.8e-3}, {0.5e-3, -0.8e-3}};
  mesh.triangle = {{0, 1, 2}, {0, 3, 1}};
  scene.body("pair", mesh);
  World w = scene.world();
  for (NodeState& n : testing::nodes(w, 0).at) n.velocity = {0.0, 0.0};
  Pulled pulled;
  // Corners are led by hand: the same places in any precision.
  const TriangleNodes start = testing::nodes(w, 0);
  const double dt = 1e-9;
  while (w.joints.stage.data()[0] != JointStage::broken) {
    const auto opening = 1e-9 * static_cast<double>(++w.step);
    w.last_dt = dt;
    for (int k = 0; k < 3; ++k)
      testing::nodes(w, 0).at[k] = {start.at[k].position + Vec2{0.3 * opening, opening},
                                    {0.3e-9 / dt, 1e-9 / dt}};
    HostRun{}.joint_forces(w);
    const JointForce f = w.exec.precision == Precision::full
                             ? w.joints.force.in_double.data()[0]
                             : converted<double>(w.joints.force.in_single.data()[0]);
    pulled.peak = std::max(pulled.peak, norm(f.first + f.second));
  }
  pulled.spent = w.joints.work.data()[0].open + w.joints.work.data()[0].slide;
  return pulled;
}
TEST(FdemMixedPrecision, breaks_a_joint_at_its_strength_and_energy) {
  const Pulled full = pulled_apart("double"), mixed = pulled_apart("mixed"),
               single = pulled_apart("single");
  EXPECT_NEAR(mixed.peak, full.peak, nearest * full.peak);
  EXPECT_NEAR(single.peak, full.peak, some * full.peak);
  EXPECT_NEAR(mixed.spent, full.spent, nearest * full.spent);
  EXPECT_NEAR(single.spent, full.spent, some * full.spent);
}

}  // namespace fdem_mixed_precision_test
}  // namespace breccia::fdem
