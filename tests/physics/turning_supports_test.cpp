// Supports of triangles and tetrahedra that turn what they hold: where it comes to, what that
// takes, and what a bar in torsion bears.

#include <gtest/gtest.h>

#include "fdem/setup/stages.hpp"
#include "fdem3/setup/stages.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"
#include "run/method/fdem3_method.hpp"
#include "run/method/fdem_method.hpp"
#include "run/stage_control.hpp"

namespace breccia {
namespace turning_supports_test {

using fdem::testing::far;

constexpr double peak = 1e-4;  ///< when tables are at their top  [s]

/// Up and down again: 0 at 0, 1 at a, 0 at 3 a; its area is 1.5 a.
template <class Value>
OverTime<Value> hat(double a, const Value& top) {
  OverTime<Value> table;
  table.times = {0.0, a, 3.0 * a};
  table.values = {Value{}, top, Value{}};
  return table;
}

/// x about c by an angle about z.
Vec3 turned(const Vec3& x, const Vec3& c, double angle) {
  const Vec2 arm = fdem::testing::rotated({x.x - c.x, x.y - c.y}, angle);
  return {c.x + arm.x, c.y + arm.y, x.z};
}

fdem::testing::Scene plate() {
  fdem::testing::Scene s;
  s.material();
  s.config.time.max_step = 1e-7;
  s.body("plate", prepare::crossed_rectangle({{0.0, 0.0}, {0.04, 0.02}}, 0.01));
  fdem::SupportConfig& grip = s.support("grip", {-far, -far}, {far, far}, {"x", "y"});
  grip.velocity = hat<Vec2>(peak, {20.0, -10.0});
  grip.spin = hat<double>(peak, 8e3);
  grip.point = {0.03, 0.01};
  return s;
}

/// A turn by 1.2 rad about a point that goes along: all corners come to where the integrals of both
/// tables say, no length has changed, and the work is what moves.
TEST(TurningSupports, take_triangles_to_where_the_integrals_say) {
  const fdem::testing::Scene s = plate();
  fdem::World w = s.world();
  const fdem::World start = w;
  begin_ledger(w);
  fdem::testing::run_to(w, peak);
  // Corners bear the mass: a little more of it lies outside than of an even plate.
  const double inertia = 2650.0 * 0.04 * 0.02 * (0.04 * 0.04 + 0.02 * 0.02) / 12.0;
  const double moves = energies(w).balance.kinetic;
  EXPECT_GT(moves, 0.5 * inertia * 64e6);
  EXPECT_LT(energies(w).balance.error_relative, 1e-3);
  EXPECT_NEAR(energies(w).balance.work, moves, 1e-3 * moves);
  EXPECT_LT(energies(w).balance.elastic, 1e-9 * moves);
  fdem::testing::run_to(w, 3.5 * peak);
  const double angle = 8e3 * 1.5 * peak;
  const Vec3 way{20.0 * 1.5 * peak, -10.0 * 1.5 * peak, 0.0};
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec2 from = fdem::testing::nodes(start, t).at[k].position;
      const Vec2 now = fdem::testing::nodes(w, t).at[k].position;
      const Vec3 wanted = turned({from.x, from.y, 0.0}, {0.03, 0.01, 0.0}, angle) + way;
      EXPECT_LT(norm(now - Vec2{wanted.x, wanted.y}), 1e-6) << t;
    }
  EXPECT_LT(energies(w).balance.elastic, 1e-9 * moves);
  EXPECT_LT(energies(w).balance.error_relative, 1e-3);
}

fdem3::testing::Scene block() {
  fdem3::testing::Scene s;
  s.material();
  s.config.time.max_step = 1e-7;
  s.body("block", prepare::kuhn_box({}, {0.04, 0.02, 0.02}, 0.01));
  fdem3::SupportConfig& grip =
      s.support("grip", {-far, -far, -far}, {far, far, far}, {"x", "y", "z"});
  grip.velocity = hat<Vec3>(peak, {20.0, -10.0, 30.0});
  grip.spin = hat<Vec3>(peak, {0.0, 0.0, 8e3});
  grip.point = {0.03, 0.01, 0.5};
  return s;
}
TEST(TurningSupports, take_tetrahedra_to_where_the_integrals_say) {
  const fdem3::testing::Scene s = block();
  fdem3::World w = s.world();
  const fdem3::World start = w;
  begin_ledger(w);
  while (w.time < peak) step(w);
  const double moves = energies(w).balance.kinetic;
  EXPECT_NEAR(energies(w).balance.work, moves, 1e-3 * moves);
  while (w.time < 3.5 * peak) step(w);
  const Vec3 way = 1.5 * peak * Vec3{20.0, -10.0, 30.0};
  for (Index t = 0; t < w.tetrahedra.size(); ++t)
    for (int k = 0; k < 4; ++k) {
      const Vec3 from = start.tetrahedra.nodes.data()[t].at[k].position;
      const Vec3 now = w.tetrahedra.nodes.data()[t].at[k].position;
      const Vec3 wanted = turned(from, {0.03, 0.01, 0.5}, 8e3 * 1.5 * peak) + way;
      EXPECT_LT(norm(now - wanted), 1e-6) << t;
    }
  EXPECT_LT(energies(w).balance.error_relative, 1e-3);
}

/// About an axis aslant, all at once: after a whole turn it is where it was.
TEST(TurningSupports, turn_about_any_axis) {
  fdem3::testing::Scene s = block();
  fdem3::SupportConfig& grip = s.config.supports[0];
  const double speed = 1e4, root = std::sqrt(3.0);
  grip.velocity = Vec3{};
  grip.spin = Vec3{speed / root, -speed / root, speed / root};
  fdem3::World w = s.world();
  const fdem3::World start = w;
  const double round = 2.0 * pi / speed;
  while (w.time < round) step(w);
  for (Index t = 0; t < w.tetrahedra.size(); ++t)
    for (int k = 0; k < 4; ++k) {
      const Vec3 from = start.tetrahedra.nodes.data()[t].at[k].position;
      const Vec3 now = w.tetrahedra.nodes.data()[t].at[k].position;
      // as far beyond as the last step goes
      EXPECT_LT(norm(now - from), 1e-7 + 1.01 * (w.time - round) * speed * norm(from - grip.point));
    }
}

/// Torque of a square bar whose head is turned, over that of the closed answer, T = 0.1406 G a^4
/// angle/length (Timoshenko and Goodier, Theory of Elasticity, 3rd ed., section 109).
double torsion(double edge) {
  fdem3::testing::Scene s;
  s.material(30e9, 0.2, 2500.0);
  s.config.time.evaluate_every = 20;
  s.config.local_damping = 0.3;
  const double side = 0.02, length = 0.04, speed = 10.0 / 3.0;
  s.body("bar", prepare::kuhn_box({}, {side, side, length}, edge));
  s.support("foot", {-far, -far, -far}, {far, far, -0.0199}, {"x", "y"});
  fdem3::SupportConfig& head = s.support("head", {-far, -far, 0.0199}, {far, far, far}, {"x", "y"});
  head.spin = Vec3{0.0, 0.0, speed};
  head.history.times = {0.0, 1e-4, 2e-4};
  head.history.factors = {1.0, 1.0, 0.0};
  fdem3::World w = s.world();
  while (w.time < 4e-4) step(w);
  const double angle = speed * 1.5e-4, shear = 30e9 / 2.4;
  const auto read = [&](const char* on) {
    return probe(w, {"", on, "torque_z", "sum", {}, {}, {0.0, 0.0, 0.0}});
  };
  EXPECT_NEAR(read("head"), -read("foot"), 0.01 * std::abs(read("foot")));
  return read("foot") / (0.1406 * shear * side * side * side * side * angle / length);
}
/// Elements of constant strain are too stiff in torsion, by a share that falls with the square of
/// their number.
TEST(TurningSupports, twist_a_bar_as_torsion_says) {
  const double four = torsion(0.02 / 4.0), six = torsion(0.02 / 6.0);
  EXPECT_GT(four, six);
  EXPECT_GT(six, 1.0);
  EXPECT_NEAR(six - (four - six) * 16.0 / 20.0, 1.0, 0.03) << four << ", " << six;
}

/// A stage turns on about the point to which the velocity of the stage before has brought the axis,
/// or about a point of its own; a support of which it says nothing else stands still.
TEST(TurningSupports, go_on_in_a_stage_from_where_they_are) {
  fdem::testing::Scene s = plate();
  s.config.time.max_step = 1e-8;
  s.config.time.end = 1.0;
  fdem::SupportConfig& grip = s.config.supports[0];
  grip.velocity = Vec2{20.0, 0.0};
  grip.spin = 0.0;
  s.config.stages.resize(3);
  const char* names[] = {"go", "turn", "again"};
  for (std::size_t k = 0; k < 3; ++k) {
    s.config.stages[k].name = names[k];
    s.config.stages[k].until = 1e-4;
  }
  fdem::SupportChange turn, again;
  turn.name = again.name = "grip";
  turn.spin = 1e3;
  again.spin = -2e3;
  again.point = {0.0, 0.0};
  s.config.stages[1].supports = {turn};
  s.config.stages[2].supports = {again};
  s.config.probes = {{"x", "plate", "position_x", "mean"}, {"y", "plate", "position_y", "mean"}};
  const auto method = make_method(s.config, s.model, {}, nullptr);
  StageControl stages(*method, s.config.probes, "", nullptr);
  while (!stages.finished()) {
    method->advance(stages.limited({1.0, 1'000'000}));
    stages.look();
  }
  const std::vector<StageRecord> r = stages.records();
  const double way = 20.0 * (r[0].end - r[0].begin);
  Vec3 middle{way, 0.0, 0.0};
  middle = turned(middle, {0.03 + way, 0.01, 0.0}, 1e3 * (r[1].end - r[1].begin));
  middle = turned(middle, {}, -2e3 * (r[2].end - r[2].begin));
  const std::vector<double> now = method->probes();
  EXPECT_NEAR(now[0], middle.x, 1e-9);
  EXPECT_NEAR(now[1], middle.y, 1e-9);
}

TEST(TurningSupports, that_do_not_hold_what_they_turn_are_problems) {
  fdem::testing::Scene plane = plate();
  plane.config.supports[0].fix = {"x"};
  plane.config.supports[0].velocity = Vec2{};
  const std::vector<std::string> said = fdem::stage_problems(plane.config);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0], "support.grip.spin moves what it holds along y, which it does not fix");

  fdem3::testing::Scene solid = block();
  fdem3::SupportConfig& grip = solid.config.supports[0];
  grip.fix = {"x", "y"};
  grip.velocity = Vec3{};
  EXPECT_TRUE(fdem3::stage_problems(solid.config).empty());
  grip.spin = Vec3{0.0, 5.0, 0.0};
  ASSERT_EQ(fdem3::stage_problems(solid.config).size(), 1U);
  grip.fix = {"x", "y", "z"};
  grip.servo.force = 1e3;
  grip.servo.speed = 1.0;
  grip.servo.axis = "y";
  EXPECT_TRUE(fdem3::stage_problems(solid.config).empty());
  grip.servo.axis = "x";
  const std::vector<std::string> led = fdem3::stage_problems(solid.config);
  ASSERT_EQ(led.size(), 1U);
  EXPECT_EQ(led[0], "support.grip.spin: its servo moves the axis aside, along x");
}

}  // namespace turning_supports_test
}  // namespace breccia
