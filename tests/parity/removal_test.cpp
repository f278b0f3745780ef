// Bodies that a stage takes out: what is left goes on as if they had never been there, what they
// held is booked, and threads, a device's schedule, ranks and resumed runs agree.

#include <gtest/gtest.h>

#include "fdem/setup/stages.hpp"
#include "parity/staged_runs.hpp"
#include "physics/dem/scene.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia {
namespace removal_test {

using namespace breccia::testing;

/// A strip, of which all that lies right of x = 0.02 is a body of its own, is held at both ends
/// under a stress, then loses that body.
fdem::testing::Scene dug(const char* joints) {
  using fdem::testing::far;
  fdem::testing::Scene s;
  s.material(30e9, 0.2, 2500.0).joints = joints;
  s.config.materials[0].joint.tension = 1e9;
  s.config.materials[0].joint.cohesion = 1e9;
  s.body("left", prepare::crossed_rectangle({{0.0, 0.0}, {0.08, 0.02}}, 0.01));
  s.model.groups.emplace_back("right");
  for (std::size_t t = 0; t < s.model.triangle.size(); ++t) {
    double x = 0.0;
    for (const Index v : s.model.triangle[t]) x += s.model.point[static_cast<std::size_t>(v)].x / 3;
    if (x > 0.02) s.model.group[t] = 1;
  }
  s.support("foot", {-far, -far}, {-0.0399, far}, {"x", "y"});
  s.support("head", {0.0399, -far}, {far, far}, {"x", "y"});
  s.config.time.end = 1.0;
  s.config.probes = {{"right", "right", "speed", "max"}, {"left", "left", "velocity_x", "max"}};
  fdem::StageConfig pull, swing, end;
  pull.name = "pull";
  pull.supports = {{"head", {"same"}, {0.5, 0.0}, 1e-5, {}}};
  pull.until = 4e-5;
  swing.name = "swing";
  swing.remove = {"right"};
  swing.until = 6e-5;
  end.name = "end";
  end.until = 2e-5;
  s.config.stages = {pull, swing, end};
  return s;
}

/// A column of linked spheres on a loose one, the prop, and a bar beside it that concrete holds.
dem::testing::Scene propped() {
  dem::testing::Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0);
  s.config.time = {.end = 1.0, .safety = 0.3};
  s.config.gravity = {0.0, 0.0, -1000.0};
  for (int i = 0; i < 4; ++i) {
    s.sphere({0.0, 0.0, 0.029998 + 0.0199 * i}, 0.01);
    if (i > 0) s.link(i - 1, i);
  }
  s.sphere({0.0, 0.0, 0.009999}, 0.01);  // a prop on the wall, which bears all
  s.sphere({0.0199, 0.0, 0.029998}, 0.01);
  s.link(0, 5);
  s.model.groups = {"column", "prop", "side"};
  s.model.group[4] = 1;
  s.model.group[5] = 2;
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  s.config.probes = {{"column", "column", "velocity_z", "min"}};
  dem::StageConfig stand, fall, end;
  stand.name = "stand";
  stand.until = 2e-4;
  stand.local_damping = 0.5;
  fall.name = "fall";
  fall.remove = {"prop"};
  fall.local_damping = 0.0;
  fall.until = 4e-4;
  end.name = "end";
  end.remove = {"side"};
  end.until = 1e-4;
  s.config.stages = {stand, fall, end};
  return s;
}

/// As a body leaves nothing is missed; what it held is work that has left the model.
template <class Scene>
void expect_booked(const Scene& s, double at_most) {
  const auto method = make_method(s.config, s.model, {}, nullptr);
  StageControl stages(*method, s.config.probes, "", nullptr);
  while (!stages.finished()) {
    method->advance(stages.limited({1.0, 1'000'000}));
    const EnergyBalance before = method->energy();
    const std::int32_t index = method->stage().index;
    stages.look();
    const EnergyBalance after = method->energy();
    if (method->stage().index == index) continue;
    EXPECT_NEAR(after.missing(), before.missing(), 1e-12 * before.total());
    if (index != 0) continue;
    EXPECT_LT(after.elastic, before.elastic);
    EXPECT_NEAR(after.work - before.work, after.total() - before.total(), 1e-9 * before.total());
  }
  EXPECT_LT(method->energy().error_relative, at_most);
}

TEST(Removal, of_joined_triangles_is_alike_on_threads_schedule_and_ranks) {
  for (const char* joints : {"intrinsic", "extrinsic", "none"}) expect_alike(dug(joints));
}
TEST(Removal, of_joined_triangles_is_resumed) {
  for (const char* joints : {"intrinsic", "none"}) expect_resumed(dug(joints));
}
/// Steps that stay as they are: where one falls, the ledger shows the difference (docs/stages.md).
template <class Scene>
Scene with_step(Scene s, double step) {
  s.config.time.max_step = step;
  return s;
}

TEST(Removal, of_joined_triangles_is_booked) {
  expect_booked(with_step(dug("intrinsic"), 4e-8), 1e-4);
  // Corners that moved as one keep half a step of the force of those that are gone.
  for (const char* joints : {"extrinsic", "none"})
    for (const double step : {6e-8, 3e-8})
      expect_booked(with_step(dug(joints), step), 5e-3 * (step / 6e-8));
}
TEST(Removal, of_spheres_is_alike_on_threads_schedule_and_ranks) {
  expect_alike(propped());
}
TEST(Removal, of_spheres_is_resumed) {
  expect_resumed(propped());
}
TEST(Removal, of_spheres_is_booked) {
  expect_booked(with_step(propped(), 1e-6), 1e-2);
}

/// Rock that stands under stress holds energy, which leaves with its body: the ledger closes.
TEST(Removal, of_rock_under_stress_is_booked) {
  using fdem::testing::far;
  for (const char* joints : {"intrinsic", "none"}) {
    fdem::testing::Scene s = with_step(dug(joints), 4e-8);
    s.config.stages[0].supports.clear();
    s.config.in_situ = {-20e6, -8e6, 3e6};
    s.support("floor", {-far, -far}, {0.0201, -0.0099}, {"x", "y"});
    s.support("roof", {-far, 0.0099}, {0.0201, far}, {"x", "y"});
    s.config.supports[0].fix = {};
    expect_booked(s, 1e-2);
    expect_alike(s);
    // Energy that all of it held at the start, by Hooke's law of plane stress.
    const auto method = make_method(s.config, s.model, {}, nullptr);
    const double held = 0.5 *
                        (20e6 * 20e6 + 8e6 * 8e6 - 2.0 * 0.2 * 20e6 * 8e6 + 2.0 * 1.2 * 3e6 * 3e6) /
                        30e9 * 0.08 * 0.02;
    EXPECT_NEAR(method->energy().elastic, held, (joints[0] == 'n' ? 1e-12 : 0.2) * held) << joints;
  }
}

/// A bar under uniform stress of which a part is taken out: until the wave from the cut has come to
/// its foot, the rest gains the impulse of the stress that no longer acts on the cut.
TEST(Removal, unloads_the_face_by_a_wave) {
  using fdem::testing::far;
  fdem::testing::Scene s = dug("none");
  s.config.materials[0].poisson = 0.0;
  s.config.stages[0].supports.clear();
  s.config.in_situ.xx = -10e6;
  s.config.time.max_step = 5e-8;
  s.config.stages[0].until = 1e-6;
  s.config.stages[1].until = 8e-6;  // a wave crosses the 60 mm that are left in 17 us
  s.config.stages.pop_back();
  s.config.probes[1] = {"left", "left", "momentum_x", "sum"};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  EXPECT_EQ(method->probes()[0], 0.0);
  const double impulse = 10e6 * 0.02 * (method->time() - 1e-6);
  EXPECT_NEAR(method->probes()[1], impulse, 0.03 * impulse);
  const Frame frame = method->frame();
  const std::size_t left = frame.triangles.size() / 3;
  EXPECT_EQ(left, s.model.triangle.size() * 3 / 4);
  EXPECT_EQ(frame.triangle_fields[0].values.size(), left);
}

/// A sphere on a prop that goes falls freely.
/// A support on the wall that a stage lays bare: free at first, then moved, then free again.
fdem::testing::Scene dug_and_moved() {
  using fdem::testing::far;
  fdem::testing::Scene s = dug("intrinsic");
  s.support("wall", {0.0199, -far}, {0.0201, far}, {}, {}, "left");
  s.config.probes = {{"wall", "wall", "velocity_x", "mean"},
                     {"most", "wall", "velocity_x", "max"},
                     {"across", "wall", "velocity_y", "max"}};
  s.config.stages[1].supports = {{"wall", {"x", "y"}, {-3.0, 0.0}, 0.0, {}}};
  s.config.stages[2].supports = {{"wall", {}, {}, 0.0, {}}};
  return s;
}
TEST(Removal, supports_move_the_wall_that_it_lays_bare) {
  const fdem::testing::Scene s = dug_and_moved();
  const auto method = make_method(s.config, s.model, {}, nullptr);
  StageControl stages(*method, s.config.probes, "", nullptr);
  double last = 0.0;
  std::int64_t moved = 0;
  while (!stages.finished()) {
    method->advance(stages.limited({1.0, method->steps() + 1}));
    const std::vector<double> now = method->probes();
    const std::int32_t stage = method->stage().index;
    if (stage == 0 && method->time() > 3e-5) {
      EXPECT_GT(now[0], 1e-3);  // it goes with the strip that is pulled
    }
    if (stage == 1 && method->time() > 4.1e-5) {
      EXPECT_NEAR(now[0], -3.0, 1e-12);
      EXPECT_NEAR(now[1], -3.0, 1e-12);
      EXPECT_NEAR(now[2], 0.0, 1e-12);
      ++moved;
    }
    if (stage == 2) last = now[0];
    stages.look();
  }
  EXPECT_GT(moved, 100);
  EXPECT_GT(std::abs(last + 3.0), 0.1);  // the strip throws it back
  EXPECT_LT(method->energy().error_relative, 1e-2);
  expect_alike(s);
  expect_resumed(s);
}

TEST(Removal, lets_what_stood_on_a_prop_fall) {
  dem::testing::Scene s = propped();
  s.config.stages.pop_back();
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  // 4e-4 s at 1000 m/s2, and the spring-back of the column by less than a tenth of it
  EXPECT_NEAR(method->probes()[0], -0.4, 0.06);
}

TEST(Removal, of_bodies_that_are_not_there_or_are_gone_is_a_problem) {
  fdem::Config config;
  config.bodies.emplace_back().name = "core";
  config.bodies.emplace_back().name = "rest";
  fdem::StageConfig zero, first, second;
  zero.name = "zero";
  zero.until = 1.0;
  first.name = "a";
  first.until = 1.0;
  first.remove = {"core", "cor"};
  second.name = "b";
  second.remove = {"core"};
  config.stages = {zero, first, second};
  const std::vector<std::string> said = fdem::stage_problems(config);
  ASSERT_EQ(said.size(), 2U);
  EXPECT_EQ(said[0],
            "stage.a.remove = \"cor\" is no body; there are: core, rest; did you mean core?");
  EXPECT_EQ(said[1], "stage.b.remove: \"core\" has been taken out before");
  config.stages = {zero, second};
  config.stages = {first};
  const std::vector<std::string> more = fdem::stage_problems(config);
  ASSERT_EQ(more.size(), 2U);
  EXPECT_NE(more[1].find("stage.a.remove: the first stage"), std::string::npos);
}

}  // namespace removal_test
}  // namespace breccia
