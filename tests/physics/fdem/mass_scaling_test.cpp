// time.mass_scaling: fewer steps to the same equilibrium.

#include <gtest/gtest.h>

#include "fdem/stepping/step.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace fdem_mass_scaling_test {

using testing::far;
using testing::Scene;

/// A column of height 0.4 and width 0.1 on a held base, under its weight and a load on its top.
struct Column {
  long steps = 0;
  double reaction = 0.0, first_step = 0.0, shortening = 0.0;

  explicit Column(double scaling) {
    Scene scene;
    scene.material(1e8, 0.0, 2000.0).damping = 0.5;
    scene.config.time.mass_scaling = scaling;
    scene.config.gravity = {0.0, -10.0};
    scene.config.local_damping = 0.1;
    scene.body("column", prepare::crossed_rectangle({{0.0, 0.2}, {0.1, 0.4}}, 0.05));
    scene.support("base", {-far, -1e-6}, {far, 1e-6}, {"y"});
    LoadConfig& l = scene.load("top", "pressure", {-far, 0.399}, {far, far});
    l.pressure = 1e4;
    l.history.ramp = 0.1;
    World w = scene.world();
    first_step = w.next_dt;
    const double high = testing::value(w, "column", "position_y");
    while (w.time < 1.0) step(w), ++steps;
    reaction = testing::value(w, "base", "force_y", "sum");
    shortening = high - testing::value(w, "column", "position_y");
    EXPECT_LT(energies(w).balance.error_relative, 1e-4);
  }
};

TEST(FdemMassScaling, takes_fewer_steps_to_the_same_forces_and_places) {
  const Column plain(1.0), scaled(100.0);
  EXPECT_NEAR(scaled.first_step, 10.0 * plain.first_step, 0.03 * scaled.first_step);
  EXPECT_LT(scaled.steps, plain.steps / 9);
  const double held =
      2000.0 * 0.04 * 10.0 + 1e4 * 0.1;  // weight, less that of the base.s corners, and load  [N/m]
  EXPECT_NEAR(std::fabs(plain.reaction), held, 0.02 * held);
  EXPECT_NEAR(std::fabs(scaled.reaction), held, 0.02 * held);
  // mean over a column without Poisson's ratio: p h / (2 E) + rho g h^2 / (3 E)
  const double closed = (1e4 * 0.4 / 2.0 + 2000.0 * 10.0 * 0.16 / 3.0) / 1e8;
  EXPECT_NEAR(plain.shortening, closed, 0.02 * closed);
  EXPECT_NEAR(scaled.shortening, plain.shortening, 1e-3 * closed);
}

}  // namespace fdem_mass_scaling_test
}  // namespace breccia::fdem
