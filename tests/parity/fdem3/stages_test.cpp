// Stages of tetrahedra: bodies that go, materials that change, stress that grows with depth. Closed
// answers, a ledger that books them, and the same bits on threads, a device's schedule, ranks and
// resumed.

#include "fdem3/setup/stages.hpp"

#include "parity/staged_runs.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia {
namespace fdem3_stages_test {

using namespace breccia::testing;
using fdem3::testing::far;

constexpr double section = 0.01 * 0.01;  ///<  [m2]

/// A bar under stress, held at both ends, in three thirds: a body, and the last one is another. The
/// middle is of a material of its own.
fdem3::testing::Scene bar(const char* joints) {
  fdem3::testing::Scene s;
  for (int k = 0; k < 2; ++k) {
    fdem3::MaterialConfig& m = s.material(30e9, 0.0, 2500.0);
    m.joints = joints;
    m.joint.tension = m.joint.cohesion = 1e9;
  }
  s.body("left", prepare::kuhn_box({}, {0.06, 0.01, 0.01}, 0.005));
  s.model.groups.emplace_back("right");
  for (std::size_t t = 0; t < s.model.tetrahedron.size(); ++t) {
    double x = 0.0;
    for (const Index v : s.model.tetrahedron[t]) x += 0.25 * s.model.point[at(v)].x;
    if (x > 0.01) s.model.group[t] = 1;
    if (std::abs(x) < 0.01) s.model.material[t] = 1;
  }
  s.config.in_situ.xx = -10e6;
  s.config.time.end = 1.0;
  s.config.time.max_step = 5e-8;
  s.support("foot", {-far, -far, -far}, {-0.0299, far, far}, {"x", "y", "z"});
  s.support("head", {0.0299, -far, -far}, {far, far, far}, {"x", "y", "z"});
  s.config.probes = {{"right", "right", "speed", "max"}, {"left", "left", "momentum_x", "sum"}};
  s.config.stages.resize(2);
  fdem3::StageConfig &stand = s.config.stages[0], &change = s.config.stages[1];
  stand.name = "stand";
  stand.until = 1e-6;
  change.name = "change";
  change.until = 8e-6;  // a wave crosses the 40 mm of `left` in 11.5 us
  return s;
}
fdem3::testing::Scene dug(const char* joints) {
  fdem3::testing::Scene s = bar(joints);
  s.config.stages[1].remove = {"right"};
  return s;
}

/// Until the wave from the cut has come to its foot, the rest gains the impulse of the stress that
/// no longer acts on the cut; what the body held has left the model as work.
TEST(Fdem3Stages, take_a_body_out) {
  const fdem3::testing::Scene s = dug("none");
  const auto method = make_method(s.config, s.model, {}, nullptr);
  const double held = method->energy().elastic;
  EXPECT_NEAR(held, 0.5 * 10e6 * 10e6 / 30e9 * 0.06 * section, 1e-9 * held);
  run_to(*method, s.config, nullptr);
  EXPECT_EQ(method->probes()[0], 0.0);
  const double impulse = 10e6 * section * (method->time() - 1e-6);
  EXPECT_NEAR(method->probes()[1], impulse, 0.03 * impulse);
  EXPECT_NEAR(method->energy().work, -held / 3.0, 0.01 * held);
  EXPECT_LT(method->energy().error_relative, 1e-2);
  const Frame frame = method->frame();
  EXPECT_EQ(frame.tetrahedra.size() / 4, s.model.tetrahedron.size() * 2 / 3);
}
TEST(Fdem3Stages, that_take_a_body_out_are_alike_and_resumed) {
  expect_alike(dug("none"));
  expect_alike(dug("intrinsic"));
  expect_resumed(dug("intrinsic"));
}
/// Joints that are cut finish their step exactly.
TEST(Fdem3Stages, book_the_joints_of_a_body_that_goes) {
  const fdem3::testing::Scene s = dug("intrinsic");
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  const double impulse = 10e6 * section * (method->time() - 1e-6);
  EXPECT_NEAR(method->probes()[1], impulse, 0.1 * impulse);  // they hold no more
  EXPECT_LT(method->energy().work, 0.0);
  EXPECT_LT(method->energy().error_relative, 1e-4);
}

/// With the share q of S_0 in the middle third, and half of its modulus: S_0 + E e = q S_0 - E e, e
/// of the other two.
TEST(Fdem3Stages, soften_a_material) {
  fdem3::testing::Scene s = bar("none");
  s.config.local_damping = 0.5;
  s.config.probes = {{"left", "left", "stress_xx", "mean"},
                     {"middle", "left", "stress_xx", "mean"}};
  s.config.probes[0].min = {-far, -far, -far};
  s.config.probes[0].max = {-0.011, far, far};
  s.config.probes[1].min = {-0.009, -far, -far};
  s.config.probes[1].max = {0.009, far, far};
  s.config.time.max_step = 2e-7;
  s.config.stages[1].materials = {{"m1", 15e9, 0.25, -1.0, {}}};
  s.config.stages[1].until = 4e-4;
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  const double expected = -10e6 * (1.0 - 0.75 / 2.0);
  for (const double stress : method->probes()) EXPECT_NEAR(stress, expected, 2e-3 * 10e6);
  EXPECT_LT(method->energy().error_relative, 5e-3);
  s.config.stages[1].until = 5e-6;
  expect_alike(s);
  expect_resumed(s);
}

/// Jointed ground with K0 = 0.6 under its weight, and a block that falls on it.
fdem3::testing::Scene ground(const char* joints) {
  fdem3::testing::Scene s;
  fdem3::MaterialConfig& m = s.material(30e9, 0.2, 2500.0);
  m.joints = joints;
  m.joint.tension = 0.1e6;
  m.joint.cohesion = 0.4e6;
  s.body("ground", prepare::kuhn_box({0.0, 0.0, -2.0}, {4.0, 4.0, 4.0}, 2.0));
  s.config.gravity = {0.0, 0.0, -9.81};
  s.config.in_situ.zz_slope.z = 2500.0 * 9.81;
  s.config.in_situ.xx_slope.z = s.config.in_situ.yy_slope.z = 0.6 * 2500.0 * 9.81;
  s.config.time.end = 1.0;
  s.support("foot", {-far, -far, -far}, {far, far, -3.99}, {"z"});
  s.support("sides_x", {-1.99, -far, -far}, {1.99, far, far}, {"x"});
  s.support("sides_y", {-far, -1.99, -far}, {far, 1.99, far}, {"y"});
  s.config.supports[1].region.outside = s.config.supports[2].region.outside = true;
  s.config.probes = {{"speed", "", "speed", "max"}, {"deep", "", "stress_zz", "min"}};
  s.config.stages.resize(2);
  fdem3::StageConfig &stand = s.config.stages[0], &end = s.config.stages[1];
  stand.name = "stand";
  stand.until = 1e-3;
  end.name = "end";
  end.until = 1e-3;
  end.materials = {{"m0", 20e9, -1.0, -1.0, {}}};
  return s;
}
TEST(Fdem3Stages, stand_under_stress_that_grows_with_depth) {
  const fdem3::testing::Scene s = ground("none");
  const auto method = make_method(s.config, s.model, {}, nullptr);
  EXPECT_TRUE(method->warnings().empty());
  run_to(*method, s.config, nullptr);
  EXPECT_LT(method->probes()[0], 1e-9);                         // 0.02 m/s fallen freely
  EXPECT_NEAR(method->probes()[1], -2500.0 * 9.81 * 3.5, 1.0);  // middles of the lowest
  fdem3::testing::Scene loose = ground("none");
  loose.config.in_situ.zz_slope.z *= 0.5;
  EXPECT_NE(make_method(loose.config, loose.model, {}, nullptr)
                ->warnings()
                .at(0)
                .find("not in equilibrium with gravity"),
            std::string::npos);
}
TEST(Fdem3Stages, under_stress_that_grows_with_depth_are_alike_and_resumed) {
  fdem3::testing::Scene s = ground("intrinsic");
  s.body("block", prepare::kuhn_box({0.3, 0.2, 0.501}, {1.0, 1.0, 1.0}, 1.0), {1.0, 0.0, -8.0});
  s.config.stages[1].materials = {{"m0", 20e9, 0.5, -1.0, {}}};
  for (fdem3::StageConfig& stage : s.config.stages) stage.until = 4e-4;
  expect_alike(s);
  expect_resumed(s);
}

}  // namespace fdem3_stages_test
}  // namespace breccia
