// Gas of an explosive in a hole: its pressure follows from how far the hole has grown.

#include "fdem_shared/laws/explosive.hpp"

#include <gtest/gtest.h>

#include "core/servo.hpp"
#include "fdem/fluid/cavity.hpp"
#include "fdem/fluid/fluid.hpp"
#include "fdem_shared/fluid/gas.hpp"
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
Vec2 mean_place(const World& w, Index t) {
  const auto& at = w.triangles.nodes.data()[t].at;
  return (1.0 / 3.0) * (at[0].position + at[1].position + at[2].position);
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
  EXPECT_NEAR(w.fluid.gas.data()[0].pressure, gas.pressure(1.0), 1e-9 * gas.pressure(1.0));
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
  const double pressure = w.fluid.gas.data()[0].pressure;
  EXPECT_NEAR(pressure, gas.pressure(volume), 1e-3 * pressure);
  EXPECT_LT(pressure, 0.97 * gas.pressure(before));
  const double ratio = inner * inner / (outer * outer - inner * inner);
  const double widening = pressure * (1.0 + nu) / young *
                          ((1.0 - 2.0 * nu) * ratio + ratio * outer * outer / (inner * inner));
  EXPECT_NEAR(std::sqrt(volume / before) - 1.0, widening, 0.06 * widening);
  const double given = charge * (gas.energy(before) - gas.energy(volume));
  EXPECT_NEAR(sum.work, given, 0.01 * given);
}

TEST(Explosive, pushes_a_closed_wall_by_the_area_that_it_gains) {
  const Vec2 from[3] = {{0.0, 0.0}, {1.0, 0.2}, {0.3, 0.9}};
  const Vec2 to[3] = {{-0.2, 0.1}, {1.4, -0.3}, {0.9, 1.8}};
  const auto area = [](const Vec2(&x)[3]) { return 0.5 * cross(x[1] - x[0], x[2] - x[0]); };
  double swept = 0.0;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    swept += fdem_shared::swept({from[k], from[next]}, {to[k], to[next]});
  }
  EXPECT_NEAR(swept, area(to) - area(from), 1e-15);
}

double energy_of_gas(const World& w) {
  return w.given->fluids[0].charge * w.fluid.gas.data()[0].energy;
}

/// An open slit from the wall into a ring that nothing moves: gas that fills it does no work, so
/// its energy stays, and an ideal gas keeps p V.
TEST(Explosive, keeps_its_energy_as_it_runs_into_an_open_slit) {
  Scene s = charged(0.0, 50e9);
  s.config.loads[0].explosive = {0.0, 0.0, 1.0, 1.0, 0.4, 1e8, 0.0};
  s.config.loads[0].speed = 200.0;
  s.config.time.max_step = 1e-6;
  s.support("all", {-1.0, -1.0}, {1.0, 1.0}, {"x", "y"});
  for (Index layer = 0; layer < 5; ++layer)
    s.model.discontinuities.push_back({{48 * layer, 48 * (layer + 1)}, -1});
  World w = s.world();
  for (const auto& crack : w.given->open_cracks)
    for (const Index edge : {crack.a, crack.b})
      for (const Index node : {edge, JointEnds::next_corner(edge)}) {
        Vec2& x = w.triangles.nodes.data()[node / 3].at[node % 3].position;
        const Vec2 middle = mean_place(w, node / 3);
        x.y = middle.y > 0.0 ? 1e-3 : -1e-3;
      }
  spread_fluid(w);
  const double volume = gas_volume(w, w.given->fluids[0]);
  const double pressure = w.fluid.gas.data()[0].pressure, energy = energy_of_gas(w);
  EXPECT_NEAR(pressure * volume, 0.4 * energy, 1e-12 * energy);
  run_to(w, 2e-4);
  const double filled = gas_volume(w, w.given->fluids[0]);
  EXPECT_GT(filled, 1.03 * volume);
  EXPECT_NEAR(energy_of_gas(w), energy, 1e-12 * energy);
  EXPECT_NEAR(w.fluid.gas.data()[0].pressure * filled, pressure * volume, 1e-12 * energy);
  EXPECT_NEAR(energies(w).balance.work, 0.0, 1e-12 * energy);
}

/// A ring that gas breaks, and whose cracks it enters at 100 m/s: what it gave is in the ledger.
TEST(Explosive, gives_the_ledger_all_that_it_loses_as_it_enters_cracks) {
  Scene s = charged(0.1 * hole_at_start(), 10e9);
  MaterialConfig& rock = s.config.materials[0];
  rock.joints = "intrinsic";
  rock.joint.tension = 5e6;
  rock.joint.cohesion = 20e6;
  rock.joint.energy_open = 100.0;
  rock.joint.energy_slide = 500.0;
  s.config.loads[0].speed = 100.0;
  World w = s.world();
  const double energy = energy_of_gas(w);
  run_to(w, 3e-4);
  EXPECT_GT(filled_part(w, 0).volume, 0.05 * gas_volume(w, w.given->fluids[0]));
  const double given = energy - energy_of_gas(w);
  EXPECT_GT(given, 0.1 * energy);
  EXPECT_NEAR(energies(w).balance.work, given, 0.01 * given);
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
