// time.mass_scaling: fewer steps to the same equilibrium.

#include <gtest/gtest.h>

#include "scene.hpp"

namespace breccia::dem {
namespace dem_mass_scaling_test {

using testing::Scene;
using testing::state;

/// Three linked spheres hang from the first, which is held: what the chain weighs and how long it
/// becomes.
struct Chain {
  long steps = 0;
  double reaction = 0.0, first_step = 0.0, sag = 0.0, stiffness = 0.0, weight = 0.0, error = 0.0;

  explicit Chain(double scaling) {
    Scene s;
    s.material("c", "concrete", 30e6, 0.2, 2400.0).tensile_strength = 1e9;
    for (const double z : {0.0, -0.02, -0.04}) s.sphere({0.0, 0.0, z}, 0.01);
    s.link(0, 1);
    s.link(1, 2);
    s.config.supports = {{"held", "", {-1.0, -1.0, -1e-3}, {1.0, 1.0, 1e-3}, {"all"}, {}, 0.0}};
    s.config.gravity = {0.0, 0.0, -10.0};
    s.config.local_damping = 0.5;
    s.config.time.mass_scaling = scaling;
    World w = s.world();
    first_step = w.next_dt;
    while (w.time < 0.05) step(w), ++steps;
    reaction = probe(w, {"", "held", "force_z", "sum"});
    sag = -0.04 - state(w, 2).position.z;
    stiffness = w.concrete.stiffness.data()[0];
    weight = 10.0 * s.model.mass[0];
    error = balance(w).error_relative;
  }
};

TEST(MassScaling, takes_fewer_steps_to_the_same_forces_and_places) {
  const Chain plain(1.0), scaled(100.0);
  EXPECT_NEAR(scaled.first_step, 10.0 * plain.first_step, 0.03 * scaled.first_step);
  EXPECT_LT(scaled.steps, plain.steps / 9);
  EXPECT_LT(scaled.error, 1.1 * plain.error);
  const double closed = 3.0 * plain.weight / plain.stiffness;  // 2 W / K and W / K
  for (const Chain* chain : {&plain, &scaled}) {
    EXPECT_NEAR(chain->sag, closed, 1e-3 * closed);
    EXPECT_NEAR(std::fabs(chain->reaction), 2.0 * chain->weight, 0.02 * chain->weight);
  }
}

}  // namespace dem_mass_scaling_test
}  // namespace breccia::dem
