// A wave that goes from spheres into tetrahedra: of matched impedances little
// comes back, of others what the impedances say.

#include <gtest/gtest.h>

#include "physics/coupled/scene.hpp"

namespace breccia::coupled {
namespace wave_test {

using namespace testing;

constexpr double radius = 0.005, spacing = 2.0 * radius;

/// A chain of linked spheres, 60 for ten spheres' width of its pulse, that ends at the face of a
/// bar of tetrahedra with its stiffness and, over its length, `heavier` times its mass.
struct Chain {
  int cells = 10;  ///< width of the pulse, in spheres
  double heavier = 1.0;
  double stiffness = 0.0;  ///< of a link  [N/m]

  int count() const { return 6 * cells; }
  double length() const { return count() * spacing; }

  Scene scene() {
    Scene s;
    s.balls.material("c", "concrete", 30e9, 0.2, 2400.0);
    for (int i = 0; i < count(); ++i) {
      const double z = -radius - spacing * (count() - 1 - i);
      const double at = (z + 0.5 * length()) / (0.5 * cells * spacing);
      const double speed = std::abs(at) < 1.0 ? 1e-3 * (1.0 + std::cos(pi * at)) : 0.0;
      const Index e = s.balls.sphere({0.0, 0.0, z}, radius, {0.0, 0.0, speed});
      if (i > 0) s.balls.link(e - 1, e);
    }
    const dem::World alone = s.balls.world();
    stiffness = alone.concrete.stiffness.data()[0];
    const double area = spacing * spacing, mass = alone.elements.mass.data()[0];
    s.solids.material(stiffness * spacing / area, 0.0, heavier * mass / (area * spacing));
    s.solids.config.materials[0].damping = 0.0;
    const double behind = 0.3 * length();  // nothing comes back from its end in time
    s.solids.body("bar",
                  prepare::kuhn_box({0.0, 0.0, 0.5 * behind}, {spacing, spacing, behind}, spacing));
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
};

/// At the sphere a quarter of the chain before its end.
struct Waves {
  double came = 0.0, returned = 0.0;  ///< largest velocities  [m/s]
  double passed = 0.0, back = 0.0;    ///< their integrals over time  [m]
};
Waves waves(Chain chain) {
  const Scene s = chain.scene();
  const auto w = s.world();
  const double speed =
      spacing * std::sqrt(chain.stiffness / w->spheres.elements.mass.data()[0]) / chain.length();
  const Index seen = 3 * chain.count() / 4;
  Waves found;
  while (w->spheres.time * speed < 0.87) {
    step(w->between);
    const double v = dem::testing::state(w->spheres, seen).velocity.z;
    const bool comes = w->spheres.time * speed < 0.5;  // then it is at the border
    double &most = comes ? found.came : found.returned, &sum = comes ? found.passed : found.back;
    if (std::abs(v) > std::abs(most)) most = v;
    sum += v * w->spheres.last_dt;
  }
  return found;
}

TEST(WaveIntoTetrahedra, returns_below_three_per_cent) {
  const Waves w = waves({});
  EXPECT_NEAR(w.came, 1e-3, 5e-5);  // half of it goes either way
  EXPECT_LT(std::abs(w.returned), 0.03 * w.came);
}

// At four times the mass and one stiffness the impedance is twice as large: (1 - 2)/(1 + 2) of a
// wave returns. That is what the pulse's integral does at any width. Its top is lower by what
// short waves lose on their way and at the border, which is of second order in spacing over width.
TEST(WaveIntoTetrahedra, returns_a_third_of_four_times_the_mass) {
  double error[3];
  for (int n = 0; n < 3; ++n) {
    const Waves w = waves({10 << n, 4.0});
    EXPECT_NEAR(w.back / w.passed, -1.0 / 3.0, 0.01 / 3.0);
    error[n] = std::abs(w.returned / w.came + 1.0 / 3.0);
  }
  EXPECT_LT(error[1], 0.3 * error[0]);
  EXPECT_LT(error[2], 0.3 * error[1]);
  EXPECT_LT(error[2], 0.01 / 3.0);
}

}  // namespace wave_test
}  // namespace breccia::coupled
