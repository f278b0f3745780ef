// Gas of an explosive in a hole: its pressure follows from how far the hole has grown.

#include "fdem_shared/laws/explosive.hpp"

#include <gtest/gtest.h>

#include "core/servo.hpp"
#include "fdem/fluid/cavity.hpp"
#include "fdem/fluid/fluid.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace explosive_test {

using testing::Scene;

constexpr double inner = 0.02, outer = 0.1;

/// A ring of sectors and layers whose widths grow with the radius.
prepare::Mesh ring(int sectors) {
  prepare::Mesh mesh;
  const int layers = static_cast<int>(std::lround(std::log(outer / inner) * sectors / (2.0 * pi)));
  const auto number = [&](int layer, int sector) {
    return static_cast<Index>(layer * sectors + sector % sectors);
  };
  for (int i = 0; i <= layers; ++i)
    for (int k = 0; k < sectors; ++k) {
      const double r = inner * std::pow(outer / inner, static_cast<double>(i) / layers);
      const double angle = 2.0 * pi * k / sectors;
      mesh.point.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
  for (int i = 0; i < layers; ++i)
    for (int k = 0; k < sectors; ++k) {
      const Index p = number(i, k), q = number(i + 1, k), r = number(i + 1, k + 1),
                  s = number(i, k + 1);
      if ((i + k) % 2 == 0) {
        mesh.triangle.push_back({p, q, r});
        mesh.triangle.push_back({p, r, s});
      } else {
        mesh.triangle.push_back({p, q, s});
        mesh.triangle.push_back({q, r, s});
      }
    }
  return mesh;
}

Scene charged(double charge, double young) {
  Scene s;
  s.config.plane = "strain";
  s.material(young, 0.2, 2000.0).damping = 0.5;
  s.body("rock", ring(48));
  LoadConfig& load = s.load("anfo", "fluid", {-0.021, -0.021}, {0.021, 0.021});
  load.explosive = {49.46e9, 1.891e9, 3.907, 1.118, 0.333, 2.484e9, charge};
  return s;
}
void run_to(World& w, double time) {
  while (w.time < time) {
    step(w);
    if (w.step % servo_every == 0) spread_fluid(w);
  }
}
/// Of the polygon that the wall is.
double hole_at_start() {
  return 0.5 * 48.0 * inner * inner * std::sin(2.0 * pi / 48.0);
}
const fdem_shared::ExplosiveGas gas =
    fdem_shared::ExplosiveGas::of(49.46e9, 1.891e9, 3.907, 1.118, 0.333, 2.484e9);

TEST(Explosive, that_fills_its_hole_begins_with_the_pressure_of_the_volume_one) {
  const World w = charged(0.0, 50e9).world();
  EXPECT_NEAR(w.given->fluids[0].charge, hole_at_start(), 1e-12 * hole_at_start());
  EXPECT_NEAR(w.fluid.gas.data()[0], gas.pressure(1.0), 1e-9 * gas.pressure(1.0));
}

/// At rest the gas has the pressure of its volume, the ring that of Lame, and the ledger the energy
/// that the gas gave: charge (E(V_0) - E(V)).
TEST(Explosive, comes_to_rest_where_the_ring_bears_what_is_left_of_its_pressure) {
  const double young = 2e9, nu = 0.2, charge = 0.1 * hole_at_start();
  World w = charged(charge, young).world();
  const double before = gas_volume(w, w.given->fluids[0]) / charge;
  EXPECT_NEAR(before, 10.0, 1e-9);
  run_to(w, 4e-3);
  const EnergyBalance sum = energies(w).balance;
  EXPECT_LT(sum.kinetic, 1e-4 * sum.elastic);
  const double volume = gas_volume(w, w.given->fluids[0]) / charge;
  const double pressure = w.fluid.gas.data()[0];
  EXPECT_NEAR(pressure, gas.pressure(volume), 1e-3 * pressure);
  EXPECT_LT(pressure, 0.97 * gas.pressure(before));
  const double ratio = inner * inner / (outer * outer - inner * inner);
  const double widening = pressure * (1.0 + nu) / young *
                          ((1.0 - 2.0 * nu) * ratio + ratio * outer * outer / (inner * inner));
  EXPECT_NEAR(std::sqrt(volume / before) - 1.0, widening, 0.06 * widening);
  const double given = charge * (gas.energy(before) - gas.energy(volume));
  EXPECT_NEAR(sum.work, given, 0.01 * given);
}

TEST(Explosive, needs_the_whole_wall_of_a_hole) {
  const auto refused = [](const Vec2& min, const Vec2& max) -> std::string {
    Scene s = charged(0.0, 50e9);
    s.config.loads[0].region.min = min;
    s.config.loads[0].region.max = max;
    try {
      s.world();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refused({0.0, -0.021}, {0.021, 0.021}).find("takes a part of a border only"),
            std::string::npos);
  EXPECT_NE(refused({-1.0, -1.0}, {1.0, 1.0}).find("outer border"), std::string::npos);
  EXPECT_NE(refused({-0.001, -0.001}, {0.001, 0.001}).find("region"), std::string::npos);
}

}  // namespace explosive_test
}  // namespace breccia::fdem
