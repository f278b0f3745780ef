// A plate with an inclined flaw under compression: where and when its first crack starts.

#include <gtest/gtest.h>

#include "paths.hpp"
#include "physics/fdem/scene.hpp"
#include "prepare/build_fdem.hpp"
#include "run/case_keys.hpp"

namespace breccia::fdem {
namespace flawed_plate_test {

/// cases/wing_crack, small: it cracks at a tip of the flaw, by opening, at a stress within the
/// window of linear elastic fracture mechanics, 5.1 to 14.6 MPa (Lisjak 2013). Its lower end is
/// that of a flaw at 45 degrees whose faces slide: K_I of the wing is 2/sqrt(3) K_II, with
/// K_II = (1 - mu) stress/2 sqrt(pi a), and reaches sqrt(E G_I).
TEST(FlawedPlate, cracks_first_at_the_flaw_in_the_window_of_fracture_mechanics) {
  const std::string folder = std::string(source_dir) + "/cases/wing_crack";
  const auto config = read_case<Config>(folder + "/small.toml", {});
  const MaterialConfig& rock = config.materials[0];
  World w =
      make_world(config,
                 build_fdem_model(config.bodies, config.discontinuities,
                                  {{rock.name, config.materials[1].name}, {}}, config.seed, folder),
                 {});
  while (cracks(w).empty() && w.time < config.time.end)
    for (int i = 0; i < 20; ++i) step(w);
  const std::vector<Crack> all = cracks(w);
  ASSERT_FALSE(all.empty());
  const double stress =
      0.5 / 50e-3 *
      (testing::value(w, "bottom", "force_y", "sum") - testing::value(w, "top", "force_y", "sum"));
  const double half = 2.5e-3, tip = half / std::sqrt(2.0), edge = 2e-3;
  const double sliding = std::sqrt(3.0) / (1.0 - rock.friction) *
                         std::sqrt(rock.young * rock.joint.energy_open / (pi * half));
  std::printf("first crack at %.2f MPa; faces that slide, by fracture mechanics: %.2f MPa\n",
              1e-6 * std::abs(stress), 1e-6 * sliding);
  EXPECT_NEAR(sliding, 5.1e6, 0.1e6);
  EXPECT_GT(std::abs(stress), 5.1e6);
  EXPECT_LT(std::abs(stress), 14.6e6);
  const Vec2 at = 0.5 * (all[0].begin + all[0].end);
  const double side = at.x < 0.0 ? -1.0 : 1.0;
  EXPECT_LT(norm(at - Vec2{side * tip, side * tip}), edge);
  EXPECT_LT(all[0].mode, 0.5);
}

}  // namespace flawed_plate_test
}  // namespace breccia::fdem
