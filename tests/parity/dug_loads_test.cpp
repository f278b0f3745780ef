// Loads on what a stage lays bare: closed answers, problems that are told, and the same bits on
// threads, a device's schedule, ranks, and resumed.

#include "fdem/setup/check_case.hpp"
#include "parity/staged_runs.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia {
namespace dug_loads_test {

using namespace breccia::testing;
using fdem::testing::far;

constexpr double pressure = 10e6;  ///<  [Pa]

/// A stage that stands, and one that takes out the core.
template <class Config>
void dig(Config& config) {
  config.time.end = 1.0;
  config.stages.resize(2);
  config.stages[0].name = "stand";
  config.stages[0].until = 1e-6;
  config.stages[1].name = "excavate";
  config.stages[1].until = 2e-5;
  config.stages[1].remove = {"core"};
  config.probes = {{"speed", "rock", "speed", "max"}, {"x", "rock", "momentum_x", "sum"}};
}

/// Rock under the same stress in all directions in whose middle stands a core.
fdem::testing::Scene plate(const char* joints) {
  fdem::testing::Scene s;
  fdem::MaterialConfig& m = s.material(30e9, 0.2, 2500.0);
  m.joints = joints;
  m.joint.tension = m.joint.cohesion = 1e9;
  s.body("rock", prepare::crossed_rectangle({{0.0, 0.0}, {0.06, 0.06}}, 0.01));
  s.model.groups.emplace_back("core");
  for (std::size_t t = 0; t < s.model.triangle.size(); ++t) {
    Vec2 middle{};
    for (const Index v : s.model.triangle[t]) middle += (1.0 / 3.0) * s.model.point[at(v)];
    if (std::max(std::abs(middle.x), std::abs(middle.y)) < 0.01) s.model.group[t] = 1;
  }
  s.config.plane = "strain";
  s.config.in_situ.xx = s.config.in_situ.yy = -pressure;
  s.load("around", "pressure", {-far, -far}, {far, far}).pressure = pressure;
  fdem::LoadConfig& wall = s.load("wall", "pressure", {-0.02, -0.02}, {0.02, 0.02});
  wall.pressure = pressure;
  wall.dug_by = "excavate";
  dig(s.config);
  return s;
}
fdem3::testing::Scene block(const char* joints) {
  fdem3::testing::Scene s;
  fdem3::MaterialConfig& m = s.material(30e9, 0.2, 2500.0);
  m.joints = joints;
  m.joint.tension = m.joint.cohesion = 1e9;
  s.body("rock", prepare::kuhn_box({}, {0.06, 0.06, 0.06}, 0.01));
  s.model.groups.emplace_back("core");
  for (std::size_t t = 0; t < s.model.tetrahedron.size(); ++t) {
    Vec3 middle{};
    for (const Index v : s.model.tetrahedron[t]) middle += 0.25 * s.model.point[at(v)];
    const Vec3 away{std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)};
    if (std::max({away.x, away.y, away.z}) < 0.01) s.model.group[t] = 1;
  }
  s.config.in_situ.xx = s.config.in_situ.yy = s.config.in_situ.zz = -pressure;
  s.load("around", "pressure", {-far, -far, -far}, {far, far, far}).pressure = pressure;
  fdem3::LoadConfig& wall = s.load("wall", "pressure", {-0.02, -0.02, -0.02}, {0.02, 0.02, 0.02});
  wall.pressure = pressure;
  wall.dug_by = "excavate";
  dig(s.config);
  return s;
}

/// @returns the largest speed at the end  [m/s]
template <class Scene>
double speed_after(const Scene& s) {
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  EXPECT_LT(method->energy().error_relative, 1e-2);
  return method->probes()[0];
}

/// A pressure as large as the stress of before takes the place of what is dug: nothing moves.
/// Without it waves of some p/(rho c) = 1 m/s run from the wall.
template <class Scene>
void expect_rest(Scene s) {
  EXPECT_LT(speed_after(s), 1e-9);
  s.config.loads.pop_back();
  EXPECT_GT(speed_after(s), 0.5);
}
TEST(DugLoads, stand_in_for_the_rock_that_is_dug) {
  expect_rest(plate("none"));
  expect_rest(plate("intrinsic"));
  expect_rest(block("none"));
  expect_rest(block("intrinsic"));
}

/// A force acts from the stage on, by a table whose time begins with it: its impulse.
template <class Scene, class Vector>
void expect_impulse(Scene s, const Vector& whole) {
  s.config.in_situ = {};
  s.config.time.max_step = 5e-8;
  s.config.loads.erase(s.config.loads.begin());
  auto& wall = s.config.loads[0];
  wall.kind = "force";
  wall.pressure = 0.0;
  wall.force.times = {0.0, 1e-5, 1.0};
  wall.force.values = {Vector{}, whole, whole};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  StageControl stages(*method, s.config.probes, "", nullptr);
  double begin = 0.0;
  while (!stages.finished()) {
    method->advance(stages.limited({1.0, method->steps() + 37}));
    if (method->stage().index == 0) {
      EXPECT_LT(method->probes()[0], 1e-9);  // rounding alone
    }
    stages.look();
  }
  begin = stages.records()[1].begin;
  const double impulse = 1e4 * (method->time() - begin - 0.5e-5);
  EXPECT_NEAR(method->probes()[1], impulse, 0.02 * impulse);
}
TEST(DugLoads, give_the_impulse_of_their_table_from_their_stage_on) {
  expect_impulse(plate("none"), Vec2{1e4, 0.0});
  expect_impulse(block("none"), Vec3{1e4, 0.0, 0.0});
}

/// Two cores, one after the other: each load knows the walls of its own.
TEST(DugLoads, act_on_what_their_own_stage_lays_bare) {
  fdem::testing::Scene s = plate("none");
  s.model.groups.emplace_back("right");
  for (std::size_t t = 0; t < s.model.triangle.size(); ++t)
    if (s.model.group[t] == 1) {
      double x = 0.0;
      for (const Index v : s.model.triangle[t]) x += s.model.point[at(v)].x;
      if (x > 0.0) s.model.group[t] = 2;
    }
  s.config.stages[1].until = 1e-6;
  s.config.stages.emplace_back();
  s.config.stages[2].name = "widen";
  s.config.stages[2].until = 2e-5;
  s.config.stages[2].remove = {"right"};
  fdem::LoadConfig right = s.config.loads[1];
  right.name = "right";
  right.dug_by = "widen";
  s.config.loads.push_back(right);
  const fdem::World w = s.world();
  int first = 0, second = 0;
  for (const fdem::LoadedEdge& e : w.given->loaded) {
    first += e.load == 1 ? 1 : 0;
    second += e.load == 2 ? 1 : 0;
  }
  EXPECT_EQ(first, 6);   // three sides of the left half, and its border with the right one
  EXPECT_EQ(second, 4);  // three sides of the right half
  EXPECT_LT(speed_after(s), 1e-9);
}

TEST(DugLoads, are_alike_and_resumed) {
  fdem::testing::Scene s = plate("intrinsic");
  s.config.loads[1].pressure = 0.3 * pressure;
  s.config.loads[1].history.ramp = 1e-5;
  expect_alike(s);
  expect_resumed(s);
  fdem3::testing::Scene t = block("intrinsic");
  t.config.loads[1].pressure = 0.3 * pressure;
  t.config.loads[1].history.ramp = 1e-5;
  t.config.stages[1].until = 6e-6;
  expect_alike(t);
  expect_resumed(t);
}

TEST(DugLoads, that_catch_nothing_are_problems) {
  fdem::testing::Scene s = plate("none");
  s.config.loads[1].region.max = {-0.015, 0.02};
  try {
    s.world();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "load.wall: its region holds no edge that stage.excavate lays bare");
  }
  fdem3::testing::Scene t = block("none");
  t.config.loads[1].region.max = {-0.015, 0.02, 0.02};
  try {
    t.world();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "load.wall: its region holds no face that stage.excavate lays bare");
  }
  const auto tells = [](const fdem::Config& config, const std::string& text) {
    const std::vector<std::string> said = fdem::case_problems(config);
    return std::find(said.begin(), said.end(), text) != said.end();
  };
  fdem::Config config = plate("none").config;
  config.loads[1].dug_by = "excavat";
  EXPECT_TRUE(
      tells(config,
            "load.wall.dug_by = \"excavat\" is no stage; there are: stand, excavate; did you mean "
            "excavate?"));
  config.loads[1].dug_by = "stand";
  EXPECT_TRUE(tells(config,
                    "load.wall.dug_by = \"stand\": that stage takes no body out, and lays "
                    "nothing bare"));
  config.loads[1].dug_by = "excavate";
  config.loads[1].kind = "absorbing";
  EXPECT_TRUE(tells(config,
                    "load.wall.dug_by: pressure, traction and force act on what a stage lays bare; "
                    "kind \"absorbing\" on the border at the start alone"));
}

}  // namespace dug_loads_test
}  // namespace breccia
