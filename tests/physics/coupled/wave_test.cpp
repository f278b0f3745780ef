// A wave that goes from spheres into tetrahedra: matched impedances, little comes back.

#include <gtest/gtest.h>

#include "physics/coupled/scene.hpp"

namespace breccia::coupled {
namespace wave_test {

using namespace testing;

constexpr double radius = 0.005, spacing = 2.0 * radius, length = 0.6;
constexpr double width = 20.0 * radius;  // of the pulse
constexpr int count = 60, across = 1;

/// Chains of linked spheres that end at the face of a bar of tetrahedra, which goes on with its
/// mass per length and its stiffness.
Scene bar() {
  Scene s;
  s.balls.material("c", "concrete", 30e9, 0.2, 2400.0);
  for (int chain = 0; chain < across * across; ++chain)
    for (int i = 0; i < count; ++i) {
      const double x = spacing * (chain % across - 0.5 * (across - 1)),
                   y = spacing * (chain / across - 0.5 * (across - 1));
      const double z = -radius - spacing * (count - 1 - i);
      const double at = (z + 0.5 * length) / (0.5 * width);
      const double speed = std::abs(at) < 1.0 ? 1e-3 * (1.0 + std::cos(pi * at)) : 0.0;
      const Index e = s.balls.sphere({x, y, z}, radius, {0.0, 0.0, speed});
      if (i > 0) s.balls.link(e - 1, e);
    }
  const dem::World alone = s.balls.world();
  const double stiffness = alone.concrete.stiffness.data()[0];
  const double area = spacing * spacing, mass = alone.elements.mass.data()[0];
  s.solids.material(stiffness * spacing / area, 0.0, mass / (area * spacing));
  s.solids.config.materials[0].damping = 0.0;
  s.solids.body("bar", prepare::kuhn_box({0.0, 0.0, 0.5 * length},
                                         {across * spacing, across * spacing, length}, spacing));
  BondConfig bond;
  bond.name = "end";
  bond.spheres = "all";
  bond.tetrahedra = "bar";
  bond.range = 1.1;
  bond.breaks = false;
  s.bonds.push_back(bond);
  s.safety = 0.4;
  return s;
}

struct Waves {
  double came = 0.0, returned = 0.0;  ///< largest velocities  [m/s]
};
/// At the sphere a quarter of the chain before its end.
Waves waves() {
  const Scene s = bar();
  const auto w = s.world();
  const double stiffness = w->spheres.concrete.stiffness.data()[0];
  const double speed = spacing * std::sqrt(stiffness / w->spheres.elements.mass.data()[0]);
  const Index seen = 3 * count / 4;
  Waves found;
  while (w->spheres.time < 0.62 / speed) {
    step(w->between);
    const double v = dem::testing::state(w->spheres, seen).velocity.z, t = w->spheres.time * speed;
    if (t < 0.26) found.came = std::max(found.came, std::abs(v));
    if (t > 0.35) {
      if (std::abs(v) > std::abs(found.returned)) found.returned = v;
    }
  }
  return found;
}

TEST(WaveIntoTetrahedra, returns_below_three_per_cent) {
  const Waves w = waves();
  EXPECT_NEAR(w.came, 1e-3, 5e-5);  // half of it goes either way
  EXPECT_LT(std::abs(w.returned), 0.03 * w.came);
}

}  // namespace wave_test
}  // namespace breccia::coupled
