// Velocities that output shows belong to the time of the positions.

#include <gtest/gtest.h>

#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace fdem_centred_velocity_test {

using testing::nodes;
using testing::Scene;

/// Largest difference from the ledger's kinetic energy, which is the leapfrog's own, of a plate
/// that rings; over the energy.
struct Errors {
  double probe, frame, half_step_old;
};
Errors errors(double safety) {
  Scene s;
  s.material();
  s.config.time.safety = safety;
  s.body("plate", prepare::crossed_rectangle({{0.0, 0.0}, {0.2, 0.1}}, 0.05));
  World w = s.world();
  testing::stir(w, [](const Vec2& x) { return Vec2{0.1 * x.x, -0.2 * x.y}; });
  evaluate_forces(w);
  const double start = energies(w).balance.kinetic;
  Errors largest{};
  for (int i = 0; i < static_cast<int>(40.0 / safety); ++i) {
    step(w);
    const double kinetic = energies(w).balance.kinetic;
    const std::vector<Corners> now = velocities_now(w);
    double shown = 0.0, old = 0.0;
    for (Index t = 0; t < w.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Vec2 &v = now[static_cast<std::size_t>(t)].at[k], &half = nodes(w, t).at[k].velocity;
        shown += 0.5 * w.triangles.mass.data()[t] * dot(v, v);
        old += 0.5 * w.triangles.mass.data()[t] * dot(half, half);
      }
    const double probed = probe(w, {"moving", "", "kinetic", "sum"});
    largest.probe = std::max(largest.probe, std::fabs(probed - kinetic) / start);
    largest.frame = std::max(largest.frame, std::fabs(shown - kinetic) / start);
    largest.half_step_old = std::max(largest.half_step_old, std::fabs(old - kinetic) / start);
  }
  return largest;
}

TEST(CentredVelocity, gives_an_energy_whose_error_falls_with_the_square_of_the_step) {
  const Errors coarse = errors(0.4), fine = errors(0.2), finest = errors(0.1);
  EXPECT_NEAR(coarse.frame / fine.frame, 4.0, 0.6);
  EXPECT_NEAR(fine.frame / finest.frame, 4.0, 0.6);
  EXPECT_NEAR(finest.probe, finest.frame, 1e-3 * finest.frame);
  EXPECT_NEAR(coarse.half_step_old / fine.half_step_old, 2.0, 0.4);
  EXPECT_GT(finest.half_step_old, 5.0 * finest.frame);
}

}  // namespace fdem_centred_velocity_test
}  // namespace breccia::fdem
