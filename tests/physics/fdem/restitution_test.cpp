// Contacts that give back e^2 of what they take up: a body comes back with e of its velocity,
// whatever the law of its contact, its mass and its speed.

#include <gtest/gtest.h>

#include "fdem/setup/stages.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace restitution_test {

using testing::far;
using testing::Scene;

/// A body on a held block; its contact is 1e4 times as soft as itself, so that it hardly vibrates.
Scene thrown(double e, bool on_a_corner, double speed, double density = 2000.0) {
  Scene s;
  s.material(1e11, 0.2, density).contact_stiffness = 1e-4;
  s.config.contact.restitution = e;
  s.config.time.evaluate_every = 1;
  s.config.time.safety = 0.1;
  s.body("floor", prepare::crossed_rectangle({{0.0, -0.05}, {0.4, 0.1}}, 0.1));
  if (on_a_corner)
    s.triangle("ball", {0.013, 1e-5}, {0.113, 0.1}, {-0.087, 0.1}, 0, {0.0, -speed});
  else
    s.body("ball", prepare::crossed_rectangle({{0.013, 0.05 + 1e-5}, {0.1, 0.1}}, 0.05), 0,
           {0.0, -speed});
  s.support("hold", {-far, -far}, {far, far}, {"x", "y"}, {}, "floor");
  return s;
}

TEST(FdemRestitution, is_that_of_the_case) {
  for (const bool on_a_corner : {false, true})
    for (const double e : {0.2, 0.6, 0.9, 1.0})
      for (const double speed : {0.2, 2.0}) {
        World w = thrown(e, on_a_corner, speed).world();
        const double start = energies(w).balance.kinetic;
        bool met = false;
        for (long i = 0; i < 2'000'000; ++i) {
          step(w);
          const bool touches = energies(w).balance.kinetic < 0.999 * start;
          met = met || touches;
          if (met && testing::value(w, "ball", "position_y") >
                         (on_a_corner ? 0.2 / 3.0 + 2e-5 : 0.05 + 2e-5))
            break;
          if (met && i % 100 == 0 && w.time > 1.0) break;
        }
        ASSERT_TRUE(met);
        EXPECT_NEAR(testing::value(w, "ball", "velocity_y"), e * speed, 0.01 * speed)
            << on_a_corner << " " << e << " " << speed;
        const EnergyBalance b = energies(w).balance;
        EXPECT_NEAR(b.contact, (1.0 - e * e) * start, 0.02 * start) << on_a_corner << " " << e;
        EXPECT_LT(b.error_relative, 1e-6);
      }
}

/// From a stage on another one counts, also for what touches as it begins: what that has taken up
/// it gives back in part, and the ledger tells.
TEST(FdemRestitution, is_another_one_from_a_stage_on) {
  for (const bool touching : {false, true}) {
    Scene s = thrown(1.0, false, 1.0);
    s.config.stages.resize(2);
    s.config.stages[1].restitution = 0.5;
    World w = s.world();
    const double start = energies(w).balance.kinetic;
    while (touching && energies(w).balance.kinetic > 0.9 * start) step(w);
    StageProgress later;
    later.index = 1;
    configure(w, config_at(s.config, later));
    bool met = false;
    while (!met || testing::value(w, "ball", "position_y") < 0.05 + 2e-5) {
      step(w);
      met = met || energies(w).balance.kinetic < 0.5 * start;
    }
    EXPECT_NEAR(testing::value(w, "ball", "velocity_y"), 0.5, 0.01) << touching;
    EXPECT_LT(energies(w).balance.error_relative, 1e-6);
  }
}

/// After a fall of 10 um under gravity it keeps e^2 of what the fall, down to the deepest overlap,
/// gave it; there it swings about its weight without loss.
TEST(FdemRestitution, lets_bodies_come_to_rest_but_for_what_they_keep) {
  Scene s = thrown(0.3, false, 0.0);
  s.config.gravity = {0.0, -9.81};
  World w = s.world();
  double deepest = 1.0, fastest = 0.0;
  while (w.time < 0.02) {
    for (int k = 0; k < 10; ++k) step(w);
    deepest = std::min(deepest, testing::value(w, "ball", "position_y"));
    if (w.time > 0.01)
      fastest = std::max(fastest, std::abs(testing::value(w, "ball", "velocity_y")));
  }
  const double height = 0.05 + 1e-5 - deepest;
  EXPECT_GT(height, 1e-5);
  EXPECT_LT(fastest, 0.3 * std::sqrt(2.0 * 9.81 * height));
}

}  // namespace restitution_test
}  // namespace breccia::fdem
