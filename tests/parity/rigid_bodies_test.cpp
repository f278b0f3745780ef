// Rigid bodies that forces move in stages: alike on threads, a device's schedule, ranks and
// resumed, and no stage moves energy that is not booked.

#include "fdem/setup/stages.hpp"
#include "fdem3/setup/stages.hpp"
#include "parity/staged_runs.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia {
namespace rigid_bodies_parity_test {

using namespace breccia::testing;

template <class Scene>
void add_stages(Scene& s, const std::vector<std::string>& free) {
  using Stage = std::remove_cvref_t<decltype(s.config.stages[0])>;
  using Change = std::remove_cvref_t<decltype(Stage{}.supports[0])>;
  s.config.stages = {Stage{}, Stage{}, Stage{}, Stage{}};
  const char* names[] = {"press", "free", "drive", "hold"};
  for (std::size_t k = 0; k < 4; ++k) {
    s.config.stages[k].name = names[k];
    s.config.stages[k].until = 1.5e-5;
  }
  Change let_go, drive, hold;
  let_go.name = drive.name = hold.name = "tool";
  let_go.free = free;
  if constexpr (requires { drive.force.value.z; })
    drive.force = fdem_shared::from_space<Vec3>({0.0, 100.0, -2e3}), drive.torque = {0.5, 0.2, 1.0};
  else
    drive.force = Vec2{1e4, -1e6}, drive.torque = 100.0;
  hold.free = {};
  s.config.stages[1].supports = {let_go};
  s.config.stages[2].supports = {drive};
  s.config.stages[3].supports = {hold};
}

/// A tool is pressed aslant into a block that cracks, let go, driven and held.
fdem::testing::Scene in_plane() {
  fdem::testing::Scene s;
  auto& m = s.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.friction = 0.5;
  m.joint.tension = 3e6;
  m.joint.cohesion = 9e6;
  m.joint.energy_open = 3.0;
  m.joint.energy_slide = 9.0;
  s.body("rock", prepare::crossed_rectangle({{0.0, -0.0151}, {0.06, 0.03}}, 0.01));
  s.body("tool", prepare::crossed_rectangle({{0.008, 0.01}, {0.02, 0.02}}, 0.01));
  s.support("tool", {-fdem::testing::far, -fdem::testing::far},
            {fdem::testing::far, fdem::testing::far}, {"x", "y"}, {2.0, -20.0}, "tool");
  add_stages(s, {"x", "y", "turn"});
  return s;
}
fdem3::testing::Scene in_space() {
  fdem3::testing::Scene s = fdem3::testing::meeting_cubes();
  fdem3::SupportConfig& tool =
      s.support("tool", {-fdem3::testing::far, -fdem3::testing::far, -fdem3::testing::far},
                {fdem3::testing::far, fdem3::testing::far, fdem3::testing::far}, {"x", "y", "z"},
                {3.0, 0.0, -30.0});
  tool.region.on = "high";
  add_stages(s, {"x", "y", "z", "turn"});
  return s;
}

TEST(RigidBodiesRuns, are_alike) {
  expect_alike(in_plane());
  expect_alike(in_space());
}
TEST(RigidBodiesRuns, are_resumed) {
  expect_resumed(in_plane());
  expect_resumed(in_space());
}

template <class Scene>
void expect_booked(const Scene& s) {
  const auto method = make_method(s.config, s.model, {}, nullptr);
  StageControl stages(*method, s.config.probes, "", nullptr);
  double worst = 0.0, largest = 0.0;
  while (!stages.finished()) {
    const double missing = method->energy().missing();
    const auto index = method->stage().index;
    method->advance(stages.limited({1.0, method->steps() + 1}));
    stages.look();
    const EnergyBalance now = method->energy();
    largest = std::max(largest, now.kinetic);
    if (method->stage().index != index) worst = std::max(worst, std::abs(now.missing() - missing));
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_LT(worst, 1e-3 * largest);
  EXPECT_LT(method->energy().error_relative, 2e-2);
}
TEST(RigidBodiesRuns, book_what_stages_do) {
  expect_booked(in_plane());
  expect_booked(in_space());
}

std::string problem_of(const fdem::Config& config) {
  const std::vector<std::string> all = fdem::stage_problems(config);
  return all.empty() ? "" : all.front();
}
TEST(RigidBodiesRuns, refuse_what_contradicts) {
  fdem::testing::Scene s = in_plane();
  EXPECT_EQ(problem_of(s.config), "");
  fdem::Config wrong = s.config;
  wrong.supports[0].free = {"z"};
  EXPECT_NE(problem_of(wrong).find("\"z\" is no direction"), std::string::npos);
  wrong = s.config;
  wrong.supports[0].force = Vec2{1.0, 0.0};
  EXPECT_NE(problem_of(wrong).find("force acts on what is free"), std::string::npos);
  wrong = s.config;
  wrong.stages[2].supports[0].velocity = Vec2{1.0, 0.0};
  EXPECT_NE(problem_of(wrong).find("goes on with the motion that it has"), std::string::npos);
  wrong = s.config;
  wrong.stages[1].supports[0].fix = {"x"};
  EXPECT_NE(problem_of(wrong).find("fix must hold all"), std::string::npos);
  wrong = s.config;
  wrong.stages[1].supports[0].servo.speed = 1.0;
  EXPECT_NE(problem_of(wrong).find("leads what free lets go"), std::string::npos);
  wrong = s.config;
  wrong.stages[1].supports[0].free = {"x"};
  wrong.stages[2].supports[0].torque = 1.0;
  EXPECT_NE(problem_of(wrong).find("does not let it turn"), std::string::npos);
}

}  // namespace rigid_bodies_parity_test
}  // namespace breccia
