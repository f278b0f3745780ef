// A prism of few tetrahedra that is pressed until it falls apart: its pieces grind each other, and
// their contacts give nothing out.

#include <gtest/gtest.h>

#include "physics/fdem3/scene.hpp"
#include "prepare/build_fdem3.hpp"

namespace breccia::fdem3 {
namespace crushed_prism_test {

/// Pushes of exposed faces alone, with overlaps of which some had begun before they touched, gave
/// out 1 % of the work here (3.5 % on a free mesh), whatever the step.
TEST(CrushedPrism, contacts_of_its_pieces_give_out_no_energy) {
  testing::Scene s;
  auto& rock = s.material(30e9, 0.25, 2600.0);
  rock.joints = "intrinsic";
  rock.friction = 0.6;
  rock.damping = 0.3;
  rock.joint.tension = 6e6;
  rock.joint.cohesion = 20e6;
  rock.joint.friction_angle = 35.0 / 180.0 * pi;
  rock.joint.energy_open = 60.0;
  rock.joint.energy_slide = 300.0;
  BodyConfig prism;
  prism.name = "prism";
  prism.shape = "box";
  prism.material = rock.name;
  prism.size = {0.03, 0.03, 0.06};
  prism.mesh_size = 0.015;
  prism.structured = true;
  s.config.bodies = {prism};
  constexpr double far = testing::far;
  s.support("foot", {-far, -far, -far}, {far, far, -0.0299}, {"z"});
  s.support("head", {-far, -far, 0.0299}, {far, far, far}, {"z"}, {0.0, 0.0, -0.25}).history.ramp =
      1e-4;
  s.model = build_model(s.config, "");
  World w = s.world();
  double least = 0.0, work = 0.0;
  for (int i = 0; w.time < 0.9e-3; ++i) {
    step(w);
    if (i % 200 != 0) continue;
    const EnergyBalance b = energies(w).balance;
    least = std::min(least, b.contact);
    work = b.work;
  }
  EXPECT_GT(cracks(w).size(), 20U);
  EXPECT_GT(work, 1.0);
  EXPECT_GT(least, -1e-4 * work);
  EXPECT_LT(std::abs(energies(w).balance.contact), 2e-3 * work);
}

}  // namespace crushed_prism_test
}  // namespace breccia::fdem3
