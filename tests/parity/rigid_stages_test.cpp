// Rigid bodies that forces move as stages change them: they lose parts, are held and let go again,
// and no damping slows them.

#include "fdem/setup/stages.hpp"
#include "parity/staged_runs.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia {
namespace rigid_stages_test {

using namespace breccia::testing;

constexpr double side = 0.02, density = 2650.0, mass = side * side * density;  ///< of a square

/// Two squares, apart by 1 mm, that one support holds; sums of momentum are probed.
fdem::testing::Scene squares(int count) {
  using fdem::testing::far;
  fdem::testing::Scene s;
  s.material();
  s.config.time.max_step = 2e-8;
  s.config.time.end = 1.0;
  const char* names[] = {"head", "ballast"};
  for (int k = 0; k < count; ++k)
    s.body(names[k], prepare::crossed_rectangle({{0.021 * k, 0.0}, {side, side}}, 0.01));
  s.support("tool", {-far, -far}, {far, far}, {"x", "y"}).free = {"x", "y", "turn"};
  s.config.probes = {{"px", "tool", "momentum_x", "sum"}, {"py", "tool", "momentum_y", "sum"}};
  return s;
}
void add_stages(fdem::testing::Scene& s, std::size_t count) {
  s.config.stages.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    s.config.stages[k].name = std::string(1, static_cast<char>('a' + k));
    s.config.stages[k].until = 1e-5;
  }
}

/// What is left goes on with the velocity and spin that it had within the whole.
TEST(RigidStages, lose_a_part_that_is_taken_out) {
  constexpr double spin = 1e3, arm = 0.0105;
  fdem::testing::Scene s = squares(2);
  s.config.supports[0].spin = spin;
  add_stages(s, 2);
  s.config.stages[1].remove = {"ballast"};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  const double angle = spin * method->stage().begin[1];
  const std::vector<double> p = method->probes();
  EXPECT_NEAR(p[0], mass * spin * arm * std::sin(angle), 1e-4 * mass * spin * arm);
  EXPECT_NEAR(p[1], -mass * spin * arm * std::cos(angle), 1e-4 * mass * spin * arm);
  // Masses lie at the corners: the inertia of a square of n = 2 edges a side is 1 + 1/n^2 times
  // that of an even one.
  const double inertia = 1.25 * mass * side * side / 6.0;
  const double moves = 0.5 * mass * spin * spin * arm * arm + 0.5 * inertia * spin * spin;
  EXPECT_NEAR(method->energy().kinetic, moves, 1e-4 * moves);
  expect_alike(s);
  expect_resumed(s);
}

/// Freed again it has the motion of that moment, not the one it had when it was free before.
TEST(RigidStages, are_let_go_again_with_the_motion_they_have) {
  fdem::testing::Scene s = squares(1);
  s.config.supports[0].spin = 2e3;
  s.config.supports[0].velocity = Vec2{0.0, -3.0};
  add_stages(s, 3);
  fdem::SupportChange hold, let_go;
  hold.name = let_go.name = "tool";
  hold.free = {};
  hold.velocity = Vec2{1.0, 0.0};
  let_go.free = {"x", "y", "turn"};
  s.config.stages[1].supports = {hold};
  s.config.stages[2].supports = {let_go};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  EXPECT_NEAR(method->probes()[0], mass, 1e-9 * mass);
  EXPECT_NEAR(method->probes()[1], 0.0, 1e-9 * mass);
  EXPECT_NEAR(method->energy().kinetic, 0.5 * mass, 1e-9 * mass);
  expect_resumed(s);
}

/// Force and torque of a stage grow from its beginning on, and are gone in the next one.
TEST(RigidStages, are_pushed_by_the_ramps_of_a_stage) {
  constexpr double force = 2e5, torque = 1e3, ramp = 1e-5;
  fdem::testing::Scene s = squares(1);
  s.config.probes.push_back({"turn", "tool", "angular_momentum_z", "sum"});
  add_stages(s, 3);
  fdem::SupportChange push, rest;
  push.name = rest.name = "tool";
  push.force = Vec2{force, 0.0};
  push.torque = torque;
  push.ramp = ramp;
  s.config.stages[1].supports = {push};
  s.config.stages[2].supports = {rest};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  EXPECT_NEAR(method->probes()[0], 0.5 * force * ramp, 5e-3 * force * ramp);
  EXPECT_NEAR(method->probes()[2], 0.5 * torque * ramp, 5e-3 * torque * ramp);
  EXPECT_LT(method->energy().error_relative, 1e-3);
  expect_resumed(s);
}

TEST(RigidStages, are_not_slowed_by_local_damping) {
  fdem::testing::Scene s = squares(1);
  s.config.local_damping = 0.5;
  s.config.gravity = Vec2{0.0, -1e4};
  s.config.supports[0].force = Vec2{2e5, 0.0};
  s.config.supports[0].torque = 1e3;
  add_stages(s, 1);
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  const double t = method->time();
  EXPECT_NEAR(method->probes()[0], 2e5 * t, 1e-8 * 2e5 * t);
  EXPECT_NEAR(method->probes()[1], -1e4 * mass * t, 1e-8 * 1e4 * mass * t);
  EXPECT_NEAR(method->energy().damping, 0.0, 1e-9 * method->energy().kinetic);
}

/// A rigid block that an elastic one stops, with damping or without, feels the same contact.
TEST(RigidStages, feel_what_they_touch_whole_where_there_is_damping) {
  double momentum[2] = {};
  for (const int damped : {0, 1}) {
    fdem3::testing::Scene s = fdem3::testing::meeting_cubes();
    s.config.local_damping = damped != 0 ? 0.8 : 0.0;
    const double far = fdem3::testing::far;
    fdem3::SupportConfig& tool =
        s.support("tool", {-far, -far, -far}, {far, far, far}, {"x", "y", "z"}, {0.0, 0.0, -30.0});
    tool.region.on = "high";
    tool.free = {"x", "y", "z", "turn"};
    fdem3::SupportConfig& held =
        s.support("held", {-far, -far, -far}, {far, far, far}, {"x", "y", "z"});
    held.region.on = "low";
    s.config.time.end = 1.0;
    s.config.probes = {{"pz", "tool", "momentum_z", "sum"}};
    s.config.stages.resize(1);
    s.config.stages[0].name = "hit";
    s.config.stages[0].until = 2e-5;
    const auto method = make_method(s.config, s.model, {}, nullptr);
    run_to(*method, s.config, nullptr);
    momentum[damped] = method->probes()[0];
  }
  EXPECT_NEAR(momentum[1], momentum[0], 1e-9 * std::abs(momentum[0]));
}

}  // namespace rigid_stages_test
}  // namespace breccia
