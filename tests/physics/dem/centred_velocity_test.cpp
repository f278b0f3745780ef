// Velocities that output shows belong to the time of the positions.

#include <gtest/gtest.h>

#include "scene.hpp"

namespace breccia::dem {
namespace dem_centred_velocity_test {

using testing::Scene;
using testing::state;

/// Largest error of the energy of a linked pair that swings, over the energy.
struct Errors {
  double shown, half_step_old;
};
Errors errors(double safety) {
  Scene s;
  MaterialConfig& m = s.material("c", "concrete", 30e9, 0.2, 2400.0);
  m.tensile_strength = m.cohesion = 1e15;
  s.config.time.safety = safety;
  s.sphere({0.0, 0.0, 0.0}, 0.01, {-1e-3, 0.0, 0.0});
  s.sphere({0.02, 0.0, 0.0}, 0.01, {1e-3, 0.0, 0.0});
  s.link(0, 1);
  World w = s.world();
  const double kn = w.concrete.stiffness.data()[0], mass = s.model.mass[0];
  const double start = mass * 1e-6;
  Errors largest{};
  for (int i = 0; i < static_cast<int>(40.0 / safety); ++i) {
    step(w);
    const double stretch = state(w, 1).position.x - state(w, 0).position.x - 0.02;
    const auto error = [&](const Vec3& a, const Vec3& b) {
      const double energy = 0.5 * mass * (dot(a, a) + dot(b, b)) + 0.5 * kn * stretch * stretch;
      return std::fabs(energy / start - 1.0);
    };
    const MotionNow now = motion_now(w);
    largest.shown = std::max(largest.shown, error(now.velocity[0], now.velocity[1]));
    largest.half_step_old =
        std::max(largest.half_step_old, error(state(w, 0).velocity, state(w, 1).velocity));
  }
  return largest;
}

TEST(CentredVelocity, gives_an_energy_whose_error_falls_with_the_square_of_the_step) {
  const Errors coarse = errors(0.2), fine = errors(0.1), finest = errors(0.05);
  EXPECT_NEAR(coarse.shown / fine.shown, 4.0, 0.2);
  EXPECT_NEAR(fine.shown / finest.shown, 4.0, 0.2);
  EXPECT_LT(finest.shown, 1e-2);
  EXPECT_NEAR(coarse.half_step_old / fine.half_step_old, 2.0, 0.4);
  EXPECT_GT(finest.half_step_old, 10.0 * finest.shown);
}

}  // namespace dem_centred_velocity_test
}  // namespace breccia::dem
