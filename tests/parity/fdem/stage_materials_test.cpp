// Materials that a stage changes: closed answers, a ledger that books it, and the same bits on
// threads, a device's schedule, ranks and resumed.

#include "fdem/setup/stages.hpp"
#include "parity/staged_runs.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia {
namespace stage_materials_test {

using namespace breccia::testing;

/// A strip under stress at the start, held at both ends; its middle third is a material of its own,
/// which a second stage changes.
fdem::testing::Scene relaxed(const fdem::MaterialChange& change) {
  using fdem::testing::far;
  fdem::testing::Scene s;
  s.material(30e9, 0.0, 2500.0);
  s.material(30e9, 0.0, 2500.0);
  s.body("strip", prepare::crossed_rectangle({{0.0, 0.0}, {0.06, 0.01}}, 0.005));
  for (std::size_t t = 0; t < s.model.triangle.size(); ++t) {
    double x = 0.0;
    for (const Index v : s.model.triangle[t]) x += s.model.point[static_cast<std::size_t>(v)].x / 3;
    if (std::abs(x) < 0.01) s.model.material[t] = 1;
  }
  s.config.in_situ.xx = -10e6;
  s.config.local_damping = 0.5;
  s.config.time.end = 1.0;
  s.config.time.max_step = 2e-7;
  s.support("foot", {-far, -far}, {-0.0299, far}, {"x", "y"});
  s.support("head", {0.0299, -far}, {far, far}, {"x", "y"});
  s.config.probes = {{"left", "strip", "stress_xx", "mean"},
                     {"middle", "strip", "stress_xx", "mean"}};
  s.config.probes[0].min = {-far, -far};
  s.config.probes[0].max = {-0.011, far};
  s.config.probes[1].min = {-0.009, -far};
  s.config.probes[1].max = {0.009, far};
  fdem::StageConfig stand, soften;
  stand.name = "stand";
  stand.until = 1e-5;
  soften.name = "soften";
  soften.materials = {change};
  soften.until = 6e-4;
  s.config.stages = {stand, soften};
  return s;
}

std::vector<double> stresses(const fdem::testing::Scene& s, double& error) {
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  error = method->energy().error_relative;
  return method->probes();
}

/// With the share q of S_0 in the middle third: S_0 + E e = q S_0 - 2 E e, e of the other two.
TEST(StageMaterials, that_bear_less_of_the_stress_at_the_start_pass_it_to_their_neighbours) {
  double error = 0.0;
  const std::vector<double> s = stresses(relaxed({"m1", 0.0, 0.25, -1.0, {}}), error);
  const double expected = -10e6 * (1.0 - 0.75 / 3.0);
  EXPECT_NEAR(s[0], expected, 2e-3 * 10e6);
  EXPECT_NEAR(s[1], expected, 2e-3 * 10e6);
  EXPECT_LT(error, 2e-3);
}
/// And half of its modulus: S_0 + E e = q S_0 - (E/2) 2 e.
TEST(StageMaterials, that_are_softer_yield_more) {
  double error = 0.0;
  const std::vector<double> s = stresses(relaxed({"m1", 15e9, 0.25, -1.0, {}}), error);
  const double expected = -10e6 * (1.0 - 0.75 / 2.0);
  EXPECT_NEAR(s[0], expected, 2e-3 * 10e6);
  EXPECT_NEAR(s[1], expected, 2e-3 * 10e6);
  EXPECT_LT(error, 2e-3);
}
TEST(StageMaterials, that_only_become_softer_stay_where_they_are) {
  double error = 0.0;
  const std::vector<double> s = stresses(relaxed({"m1", 15e9, -1.0, -1.0, {}}), error);
  EXPECT_NEAR(s[0], -10e6, 1e-6 * 10e6);
  EXPECT_NEAR(s[1], -10e6, 1e-6 * 10e6);
  EXPECT_LT(error, 1e-9);
}
TEST(StageMaterials, are_alike_on_threads_schedule_and_ranks_and_resumed) {
  fdem::testing::Scene s = relaxed({"m1", 15e9, 0.25, 0.1, {}});
  s.config.stages[1].until = 2e-5;
  expect_alike(s);
  expect_resumed(s);
}
/// A strip that is pulled until its joints part; a second stage, which begins at two fifths of
/// 5 MPa, changes their tension.
fdem::testing::Scene pulled(double tension, double later) {
  using fdem::testing::far;
  fdem::testing::Scene s;
  fdem::MaterialConfig& m = s.material(30e9, 0.0, 2500.0);
  m.joints = "intrinsic";
  m.damping = 0.5;
  m.joint.tension = tension;
  m.joint.energy_open = 10.0;
  s.body("strip", prepare::crossed_rectangle({{0.0, 0.0}, {0.03, 0.01}}, 0.005));
  s.config.local_damping = 0.5;
  s.config.time.end = 1.0;
  s.support("foot", {-far, -far}, {-0.0149, far}, {"x", "y"});
  fdem::SupportConfig& head = s.support("head", {0.0149, -far}, {far, far}, {"x", "y"});
  head.velocity = Vec2{0.02, 0.0};
  head.history.ramp = 5e-5;
  s.config.probes = {{"force", "head", "force_x", "sum"}};
  fdem::StageConfig stand, change;
  stand.name = "stand";
  stand.until = 1.2e-4;
  change.name = "change";
  change.materials.resize(1);
  change.materials[0].name = "m0";
  change.materials[0].joint.tension = later;
  change.until = 7e-4;
  change.supports.resize(1);
  change.supports[0].name = "head";
  change.supports[0].velocity = Vec2{0.02, 0.0};
  s.config.stages = {stand, change};
  return s;
}
/// Largest force of the strip over its section.
double strength_of(const fdem::testing::Scene& s) {
  const auto method = make_method(s.config, s.model, {}, nullptr);
  StageControl stages(*method, s.config.probes, "", nullptr);
  double most = 0.0, now = 0.0;
  while (!stages.finished()) {
    method->advance(stages.limited({1.0, method->steps() + 20}));
    stages.look();
    now = std::abs(method->probes()[0]) / 0.01;
    most = std::max(most, now);
  }
  EXPECT_LT(now, 0.9 * most);
  EXPECT_LT(method->energy().error_relative, 1e-3);
  return most;
}
TEST(StageMaterials, that_have_weaker_joints_part_as_if_they_had_had_them) {
  const double weak = strength_of(pulled(3e6, -1.0)), strong = strength_of(pulled(5e6, -1.0));
  EXPECT_NEAR(strength_of(pulled(5e6, 3e6)), weak, 0.01 * weak);
  EXPECT_NEAR(strength_of(pulled(3e6, 5e6)), strong, 0.01 * strong);
  EXPECT_GT(strong, 1.3 * weak);
}
TEST(StageMaterials, that_change_their_joints_are_alike_everywhere) {
  fdem::testing::Scene s = pulled(5e6, 1e6);
  s.config.stages[1].until = 2e-5;
  expect_alike(s);
  expect_resumed(s);
}

TEST(StageMaterials, that_are_not_there_are_a_problem) {
  const fdem::testing::Scene s = relaxed({"m2", 15e9, -1.0, -1.0, {}});
  const std::vector<std::string> said = fdem::stage_problems(s.config);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("stage.soften.material.name = \"m2\""), std::string::npos) << said[0];
}

}  // namespace stage_materials_test
}  // namespace breccia
