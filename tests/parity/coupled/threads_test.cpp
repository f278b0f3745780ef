// Spheres and tetrahedra in one run: the same bits on any number of threads, and by launches of a
// device.

#include <gtest/gtest.h>

#include "physics/coupled/scene.hpp"

namespace breccia::coupled {
namespace threads_test {

using namespace testing;

/// A jointed cube that breaks on a layer of linked spheres, some of them tied to a second block.
Scene breaking_cube() {
  Scene s;
  fdem3::MaterialConfig& m = s.solids.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.friction = 0.5;
  m.joint.tension = 3e6;
  m.joint.cohesion = 9e6;
  m.joint.energy_open = 3.0;
  m.joint.energy_slide = 9.0;
  s.solids.body("cube", fdem3::testing::box({0.0, 0.0, 0.0202}, {0.02, 0.02, 0.02}, 0.01),
                {3.0, 0.0, -30.0});
  s.solids.body("base", fdem3::testing::box({0.0, 0.0, -0.0105}, {0.06, 0.06, 0.01}, 0.01));
  dem::MaterialConfig& c = s.balls.material("c", "concrete", 30e9, 0.2, 2400.0);
  c.tensile_strength = 2e6;
  c.cohesion = 6e6;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      const Index e = s.balls.sphere({-0.02 + 0.01 * i, -0.02 + 0.01 * j, 0.0051}, 0.005);
      if (j > 0) s.balls.link(e - 1, e);
      if (i > 0) s.balls.link(e - 5, e);
    }
  std::sort(s.balls.model.links.begin(), s.balls.model.links.end(),
            [](const auto& a, const auto& b) { return a.a != b.a ? a.a < b.a : a.b < b.b; });
  BondConfig bond;
  bond.name = "layer";
  bond.spheres = "all";
  bond.tetrahedra = "base";
  bond.range = 2.2;
  bond.tensile_strength = 0.5e6;
  bond.cohesion = 1e6;
  bond.energy_open = 0.3;
  bond.energy_slide = 1.0;
  s.bonds.push_back(bond);
  return s;
}

std::uint64_t hash(const Both& w) {
  return dem::state_hash(w.spheres) * 31 + fdem3::state_hash(w.tetrahedra);
}

TEST(CoupledThreads, give_the_same_bits) {
  const Scene s = breaking_cube();
  const auto run = [&](int threads, Space space = Space::host) {
    auto w = s.world(threads, space);
    while (w->spheres.step < 450) step(w->between);
    return w;
  };
  const auto one = run(1);
  const EnergyBalance e = energies(*one);
  EXPECT_GT(e.fracture, 0.0);
  EXPECT_GT(e.friction, 0.0);
  EXPECT_GT(count(one->between).broken, 0.0);
  EXPECT_GT(one->between.searches, 3);
  for (const int threads : {2, 3, 7, 0}) {  // 0: a device
    SCOPED_TRACE(threads);
    const auto w = threads > 0 ? run(threads) : run(1, Space::shadow);
    EXPECT_EQ(hash(*w), hash(*one));
    EXPECT_EQ(w->spheres.time, one->spheres.time);
    EXPECT_EQ(energies(*w).friction, e.friction);
    EXPECT_EQ(energies(*w).fracture, e.fracture);
  }
}

}  // namespace threads_test
}  // namespace breccia::coupled
