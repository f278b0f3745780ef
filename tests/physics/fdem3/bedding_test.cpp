// Tetrahedra of rock that is stiffer along its bedding than across it.

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "fdem3/setup/materials.hpp"
#include "math/constants.hpp"
#include "physics/fdem3/scene.hpp"
#include "prepare/checks/check_bodies.hpp"

namespace breccia::fdem3 {
namespace bedding_test {

using testing::far;
using testing::Scene;

/// Shale that does not break: E 30, E' 12, G' 4 GPa, nu 0.2, nu' 0.1, its planes' normal by an
/// angle from z towards x, or aslant in all directions.
MaterialConfig& shale(Scene& s, const Vec3& normal) {
  MaterialConfig& m = s.material(30e9, 0.2, 2500.0);
  m.bedding.normal = normal;
  m.bedding.young = 12e9;
  m.bedding.poisson = 0.1;
  m.bedding.shear = 4e9;
  return m;
}
/// 1/E of a pull at the angle t from the normal: cos^4 t/E' + sin^4 t/E + (1/G' - 2 nu'/E') sin^2 t
/// cos^2 t.
double closed_modulus(double angle) {
  const double c = std::cos(angle) * std::cos(angle), n = 1.0 - c;
  return 1.0 / (c * c / 12e9 + n * n / 30e9 + (1.0 / 4e9 - 2.0 * 0.1 / 12e9) * c * n);
}

/// On rollers, where the shear that comes with it is free, a column has the closed modulus: the
/// stress is alike everywhere.
TEST(Fdem3Bedding, is_felt_in_the_modulus_of_a_pressed_column) {
  for (const double from_load : {0.0, 30.0, 45.0, 60.0, 90.0}) {
    Scene s;
    const double angle = from_load * pi / 180.0;
    shale(s, {2.0 * std::sin(angle), 0.0, 2.0 * std::cos(angle)});
    s.body("column", testing::box({}, {0.02, 0.02, 0.04}, 0.01));
    s.config.local_damping = 0.5;
    s.support("foot", {-far, -far, -far}, {far, far, -0.01999}, {"z"});
    s.load("head", "pressure", {-far, -far, 0.01999}, {far, far, far}).pressure = 1e6;
    s.config.time.evaluate_every = 20;
    World w = s.world();
    while (w.time < 8e-4) step(w);
    double sum = 0.0, count = 0.0;
    for (Index t = 0; t < w.tetrahedra.size(); ++t)
      for (const NodeState& n : w.tetrahedra.nodes.data()[t].at)
        if (n.position.z > 0.0199) sum += n.position.z, count += 1.0;
    const double young = 1e6 * 0.04 / (0.02 - sum / count);
    const double closed = closed_modulus(angle);
    EXPECT_NEAR(young, closed, 1e-3 * closed) << from_load;
  }
}

/// A cube between six walls that do not move but for one: C33 across the planes, C11 along them.
TEST(Fdem3Bedding, is_felt_in_the_moduli_of_confined_rock) {
  const SolidModuli c = moduli_of([] {
    Scene s;
    return shale(s, {0.0, 0.0, 1.0});
  }());
  for (const bool across : {true, false}) {
    Scene s;
    shale(s, across ? Vec3{0.0, 0.0, 1.0} : Vec3{1.0, 0.0, 0.0});
    s.body("cube", testing::box({}, {0.02, 0.02, 0.02}, 0.01));
    s.support("all", {-far, -far, -far}, {far, far, far}, {"x", "y", "z"});
    World w = s.world();
    for (Index t = 0; t < w.tetrahedra.size(); ++t)
      for (NodeState& n : w.tetrahedra.nodes.data()[t].at) n.position.z *= 1.0 + 1e-6;
    const auto stress = [&](const char* quantity) {
      return probe(w, {"p", "cube", quantity, "mean"}) * 1e6;
    };
    EXPECT_NEAR(stress("stress_zz"), across ? c.c33 : c.c11, 1e-5 * c.c11);
    EXPECT_NEAR(stress("stress_yy"), across ? c.c13 : c.c12, 1e-5 * c.c11);
    EXPECT_NEAR(stress("stress_xx"), c.c13, 1e-5 * c.c11);
  }
}

/// With the greatest step that the bound allows a free body that rings in all its modes gains no
/// energy, whichever way its planes lie.
TEST(Fdem3Bedding, is_held_by_the_bound_on_the_step) {
  for (const Vec3& normal : {Vec3{0.0, 0.0, 1.0}, Vec3{1.0, 2.0, -0.5}})
    for (const double across : {3e9, 100e9}) {
      Scene s;
      MaterialConfig& m = shale(s, normal);
      m.bedding.young = across;
      m.bedding.shear = across == 3e9 ? 20e9 : 4e9;
      m.bedding.poisson = across == 3e9 ? 0.02 : 0.3;
      s.body("cube", testing::box({}, {0.02, 0.02, 0.02}, 0.005, 0.2));
      s.config.time.safety = 1.0;
      s.config.time.evaluate_every = 1;
      World w = s.world();
      const Random random{7, 3};
      for (Index t = 0; t < w.tetrahedra.size(); ++t)
        for (Index k = 0; k < 4; ++k) {  // corners at one vertex move as one
          const auto vertex = static_cast<std::uint64_t>(w.vertex[at(4 * t + k)]);
          const auto some = [&](std::uint32_t draw) {
            return 2e-2 * (random.uniform(vertex, draw) - 0.5);
          };
          w.tetrahedra.nodes.data()[t].at[k].velocity = {some(0), some(1), some(2)};
        }
      begin_ledger(w);
      const auto held = [&] {
        const EnergyBalance b = energies(w).balance;
        return b.kinetic + b.elastic;
      };
      for (int k = 0; k < 200; ++k) step(w);
      const double first = held();
      for (int k = 0; k < 3000; ++k) step(w);
      EXPECT_NEAR(held(), first, 0.02 * first);
    }
}

/// Stress in situ is held without a motion, with its energy C^-1 : S S / 2.
TEST(Fdem3Bedding, bears_stress_in_situ) {
  Scene s;
  shale(s, {0.0, 0.0, 1.0});
  s.body("cube", testing::box({}, {0.02, 0.02, 0.02}, 0.01));
  s.config.in_situ.zz = -12e6;
  s.config.in_situ.xx = -6e6;
  s.config.in_situ.yz = 2e6;
  s.config.in_situ.xy = 1e6;
  s.support("all", {-far, -far, -far}, {far, far, far}, {"x", "y", "z"});
  World w = s.world();
  const double density = 0.5 *
                         (12.0 * 12.0 / 12e3 + 6.0 * 6.0 / 30e3 - 2.0 * 0.1 * 72.0 / 12e3 +
                          2.0 * 2.0 / 4e3 + 1.0 / 12.5e3) *
                         1e6;
  const double held = energies(w).balance.elastic;
  EXPECT_NEAR(held, density * 8e-6, 1e-9 * held);
}

TEST(Fdem3Bedding, that_no_rock_can_have_is_a_problem) {
  Scene s;
  MaterialConfig& m = shale(s, {});
  const auto tells = [&](const std::string& text) {
    for (const std::string& said : prepare::case_problems(s.config))
      if (said.find(text) != std::string::npos) return true;
    return false;
  };
  EXPECT_TRUE(tells(".bedding.normal: its planes need a direction across them"));
  m.bedding.normal = {0.0, 0.0, 1.0};
  EXPECT_FALSE(tells(".bedding"));
  m.bedding.poisson = 0.6;
  EXPECT_TRUE(tells(".bedding: no rock has these moduli"));
  m.bedding.poisson = 0.1;
  m.joints = "intrinsic";
  EXPECT_TRUE(tells("joints.criterion = \"edge\""));
  s.config.joints.criterion = "edge";
  EXPECT_FALSE(tells(".bedding"));
}

}  // namespace bedding_test
}  // namespace breccia::fdem3
