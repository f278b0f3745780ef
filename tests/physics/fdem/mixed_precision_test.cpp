// Losses of joints and couples that store their forces in single precision. Forces follow from
// positions, so no error adds up: each is off by 2^-24 = 6e-8 of itself at most.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "scene.hpp"

namespace breccia::fdem {
namespace fdem_mixed_precision_test {

using testing::Momentum;
using testing::momentum;
using testing::Scene;

constexpr double nearest = 0x1p-24;

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

TEST(FdemMixedPrecision, forces_of_a_breaking_disc_differ_by_less_than_3e_6_after_a_step) {
  World full = impact("double").world();
  for (int i = 0; i < 600; ++i) step(full);
  ASSERT_GT(cracks(full).size(), 20U);
  World mixed = full;
  mixed.exec.precision = mixed.couples.history.precision = Precision::mixed;
  const auto round = [](auto& force) {
    force.in_single.resize(force.in_double.size());
    for (Index i = 0; i < force.in_double.size(); ++i)
      force.in_single.data()[i] = converted<float>(force.in_double.data()[i]);
    force.in_double.resize(0);
  };
  round(mixed.joints.force);
  round(mixed.couples.history.force);
  step(full);
  step(mixed);
  std::vector<double> errors;
  for (Index t = 0; t < full.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec2 f = full.triangles.force.data()[t].at[k];
      if (norm(f) > 0.0)
        errors.push_back(norm(mixed.triangles.force.data()[t].at[k] - f) / norm(f));
    }
  std::nth_element(errors.begin(), errors.begin() + static_cast<long>(errors.size() / 2),
                   errors.end());
  const double median = errors[errors.size() / 2];
  EXPECT_LT(median, 3e-6);
  EXPECT_GT(median, 1e-10);
}

TEST(FdemMixedPrecision, keeps_momentum_and_energy_of_a_breaking_disc) {
  constexpr int steps = 1500;
  std::array<double, 2> missing{}, drift{};
  for (const int mixed : {0, 1}) {
    World w = impact(mixed == 1 ? "mixed" : "double").world();
    step(w);
    const Momentum start = momentum(w);
    double impulse = 0.0;  // sum of all forces over time
    for (int i = 0; i < steps; ++i) {
      step(w);
      for (const Corners& f : w.triangles.force.host())
        for (const Vec2& v : f.at) impulse += w.last_dt * norm(v);
    }
    EXPECT_GT(cracks(w).size(), 20U);
    const Momentum end = momentum(w);
    const auto i = static_cast<std::size_t>(mixed);
    drift[i] = norm(end.linear - start.linear) / start.size;
    missing[i] = std::fabs(energies(w).balance.error_relative);
    // A couple's six forces are rounded one by one.
    EXPECT_LT(norm(end.linear - start.linear), (mixed == 1 ? nearest : 1e-14) * impulse);
  }
  EXPECT_GT(drift[1], drift[0]);
  EXPECT_LT(missing[1], 1.1 * missing[0] + 1e-6);
}

}  // namespace fdem_mixed_precision_test
}  // namespace breccia::fdem
