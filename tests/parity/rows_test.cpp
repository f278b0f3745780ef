// Rows of the history: probes and energies that are launched together are those that are read one
// by one, in the order of the case, and numbers that went wrong are told before them.

#include <cmath>

#include "exec/error.hpp"
#include "parity/staged_runs.hpp"
#include "physics/dem/scene.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia {
namespace rows_test {

using namespace breccia::testing;

/// Balls that fall on a floor, two of them linked.
dem::testing::Scene balls() {
  dem::testing::Scene s;
  dem::MaterialConfig& m = s.material("m", "concrete", 1e9, 0.2, 2500.0);
  m.tensile_strength = 4e6;
  m.cohesion = 12e6;
  s.config.time = {.end = 1.0, .safety = 0.3};
  s.config.gravity = {0.0, 0.0, -9.81};
  for (int i = 0; i < 8; ++i)
    s.sphere({0.03 * i, 0.0, 0.01001 + 1e-3 * i}, 0.01, {0.0, 0.0, -10.0});
  s.sphere({0.03 * 8, 0.0, 0.011}, 0.01);
  s.sphere({0.03 * 8, 0.0, 0.031}, 0.01);
  s.link(8, 9, dem::LinkKind::concrete);
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  s.config.walls.back().name = "floor";
  s.config.probes = {{"a", "", "velocity_z", "mean"},   {"b", "floor", "force_z", "sum"},
                     {"c", "", "damage", "max"},        {"d", "", "kinetic", "sum"},
                     {"e", "floor", "position_z", ""},  {"f", "", "broken", "sum"},
                     {"g", "", "displacement_z", "min"}};
  return s;
}
template <class Scene>
void probe_rock(Scene& s) {
  s.config.time.end = 1.0;
  s.config.probes = {{"a", "rock", "velocity_x", "max"}, {"b", "", "stress_xx", "mean"},
                     {"c", "", "damage", "max"},         {"d", "", "kinetic", "sum"},
                     {"e", "rock", "position_x", "min"}, {"f", "", "broken", "sum"},
                     {"g", "", "displacement_x", "min"}};
}
fdem::testing::Scene plate() {
  fdem::testing::Scene s;
  s.material(30e9, 0.2, 2500.0).joints = "intrinsic";
  s.body("rock", prepare::crossed_rectangle({{0.0, 0.0}, {0.06, 0.06}}, 0.02), 0, {1.0, 0.5});
  s.load("side", "pressure", {0.02, -1.0}, {1.0, 1.0}).pressure = 1e6;
  probe_rock(s);
  return s;
}
fdem3::testing::Scene block() {
  fdem3::testing::Scene s;
  s.material(30e9, 0.2, 2500.0).joints = "intrinsic";
  s.body("rock", prepare::kuhn_box({}, {0.04, 0.04, 0.04}, 0.02), {1.0, 0.5, 0.0});
  s.load("side", "pressure", {0.01, -1.0, -1.0}, {1.0, 1.0, 1.0}).pressure = 1e6;
  probe_rock(s);
  return s;
}

void take_steps(Method& method, std::int64_t end) {
  while (method.steps() < end) method.advance({1.0, end});
}

/// A case's own probes ten times over: more than are waited for at a time.
template <class Scene>
void expect_same_readings(Scene s) {
  const std::vector<ProbeConfig> own = s.config.probes;
  for (int k = 1; k < 10; ++k)
    s.config.probes.insert(s.config.probes.end(), own.begin(), own.end());
  for (const Space space : {Space::host, Space::shadow}) {
    Exec exec;
    exec.space = space;
    const auto method = make_method(s.config, s.model, exec, nullptr);
    take_steps(*method, 12);
    std::vector<double> alone;
    for (const ProbeConfig& p : own) {
      auto one = s.config;
      one.probes = {p};
      const auto other = make_method(one, s.model, exec, nullptr);
      take_steps(*other, 12);
      alone.push_back(other->probes().at(0));
    }
    EXPECT_NE(alone[0], 0.0);
    EXPECT_NE(alone[1], 0.0) << own[1].quantity;
    const EnergyBalance energy = method->energy();
    EXPECT_GT(energy.kinetic, 0.0);
    const Method::Row row = method->row();
    ASSERT_EQ(row.probes.size(), 10 * own.size());
    for (std::size_t k = 0; k < row.probes.size(); ++k)
      EXPECT_EQ(row.probes[k], alone[k % own.size()]) << own[k % own.size()].name;
    EXPECT_EQ(row.probes, method->probes());
    EXPECT_EQ(row.energy.kinetic, energy.kinetic);
    EXPECT_EQ(row.energy.elastic, energy.elastic);
    EXPECT_EQ(row.energy.work, energy.work);
  }
}
TEST(Rows, hold_what_probes_and_energies_read_one_by_one) {
  expect_same_readings(balls());
  expect_same_readings(plate());
  expect_same_readings(block());
}

/// Steps so long that an element passes its own size in one.
template <class Scene>
void expect_told(Scene s) {
  for (const Space space : {Space::host, Space::shadow}) {
    Exec exec;
    exec.space = space;
    const auto method = make_method(s.config, s.model, exec, nullptr);
    take_steps(*method, 2);
    EXPECT_THROW(method->row(), NumericsError);
  }
}
TEST(Rows, tell_numbers_that_went_wrong) {
  dem::testing::Scene s = balls();
  s.model.velocity[0] = {1e9, 0.0, 0.0};
  expect_told(s);
  fdem::testing::Scene p = plate();
  p.body("missile", prepare::crossed_rectangle({{1.0, 0.0}, {1.06, 0.06}}, 0.02), 0, {1e9, 0.0});
  expect_told(p);
}

}  // namespace rows_test
}  // namespace breccia
