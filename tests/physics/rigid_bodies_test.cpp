// Rigid bodies of triangles and tetrahedra that forces move: by force and torque as Newton and
// Euler say, on a slope, over an edge, and against elastic bodies.

#include <gtest/gtest.h>

#include "math/constants.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia {
namespace rigid_bodies_test {

const std::vector<std::string> plane_free{"x", "y", "turn"}, all_free{"x", "y", "z", "turn"};

/// Mass, centre and inertia of the corners of triangles, by plain sums.
struct PlaneBody {
  double mass = 0.0, inertia = 0.0;
  Vec2 centre{};
};
PlaneBody plane_body(const fdem::World& w, std::int16_t group) {
  PlaneBody body;
  const auto each = [&](const auto& visit) {
    for (Index t = 0; t < w.triangles.size(); ++t)
      if (w.triangles.group.data()[t] == group)
        for (const fdem::NodeState& n : fdem::testing::nodes(w, t).at)
          visit(w.triangles.mass.data()[t], n.position);
  };
  each([&](double m, const Vec2& x) { body.mass += m, body.centre += m * x; });
  body.centre = (1.0 / body.mass) * body.centre;
  each([&](double m, const Vec2& x) { body.inertia += m * dot(x - body.centre, x - body.centre); });
  return body;
}
/// How far a body of triangles has turned, by the sum of r_0 x r and r_0 . r of its corners.
double angle_since(const fdem::World& start, const fdem::World& now, std::int16_t group) {
  const Vec2 from = plane_body(start, group).centre, to = plane_body(now, group).centre;
  double across = 0.0, along = 0.0;
  for (Index t = 0; t < now.triangles.size(); ++t)
    if (now.triangles.group.data()[t] == group)
      for (int k = 0; k < 3; ++k) {
        const Vec2 a = fdem::testing::nodes(start, t).at[k].position - from;
        const Vec2 b = fdem::testing::nodes(now, t).at[k].position - to;
        across += cross(a, b);
        along += dot(a, b);
      }
  return std::atan2(across, along);
}

fdem::testing::Scene plate() {
  fdem::testing::Scene s;
  s.material();
  s.config.time.max_step = 1e-7;
  s.body("plate", prepare::crossed_rectangle({{0.01, -0.02}, {0.04, 0.02}}, 0.01));
  s.support("tool", {-fdem::testing::far, -fdem::testing::far},
            {fdem::testing::far, fdem::testing::far}, {"x", "y"})
      .free = plane_free;
  return s;
}

/// A constant force and torque: F t^2/(2 M) and T t^2/(2 J), and their work is the kinetic energy.
TEST(RigidBodies, go_by_force_and_torque_in_the_plane) {
  fdem::testing::Scene s = plate();
  s.config.gravity = Vec2{0.0, -2e4};
  s.config.supports[0].force = Vec2{3e5, 1e5};
  s.config.supports[0].torque = 4e3;
  fdem::World w = s.world();
  const fdem::World start = w;
  const PlaneBody body = plane_body(w, 0);
  fdem::testing::run_to(w, 4e-4);
  const double half = 0.5 * w.time * w.time, torque = 4e3;
  const Vec2 way = half * ((1.0 / body.mass) * Vec2{3e5, 1e5} + Vec2{0.0, -2e4});
  EXPECT_LT(norm(plane_body(w, 0).centre - body.centre - way), 1e-9 * norm(way));
  const double angle = half * torque / body.inertia;
  EXPECT_GT(angle, 0.5);
  EXPECT_NEAR(angle_since(start, w, 0), angle, 1e-6 * angle);
  foresee_motions(w);
  const EnergyBalance e = energies(w).balance;
  const double work = dot(Vec2{3e5, 1e5}, way) + torque * angle + body.mass * -2e4 * way.y;
  EXPECT_NEAR(e.kinetic, work, 1e-5 * work);
  EXPECT_NEAR(e.work, work, 1e-5 * work);
  EXPECT_LT(e.elastic, 1e-9 * work);
  EXPECT_LT(e.error_relative, 1e-7);
}

/// Without forces: velocity, spin and energy stay, and its elements hold nothing.
TEST(RigidBodies, spin_on_in_the_plane) {
  fdem::testing::Scene s = plate();
  s.config.supports[0].velocity = Vec2{5.0, -2.0};
  s.config.supports[0].spin = 2e4;
  fdem::World w = s.world();
  const fdem::World start = w;
  const PlaneBody body = plane_body(w, 0);
  const double moves = 0.5 * body.mass * 29.0 + 0.5 * body.inertia * 4e8;
  fdem::testing::run_to(w, 1e-4);
  EXPECT_NEAR(angle_since(start, w, 0), 2e4 * w.time, 1e-6);
  EXPECT_LT(norm(plane_body(w, 0).centre - body.centre - w.time * Vec2{5.0, -2.0}), 1e-12);
  foresee_motions(w);
  EXPECT_NEAR(energies(w).balance.kinetic, moves, 1e-5 * moves);
  EXPECT_NEAR(energies(w).balance.work, 0.0, 1e-5 * moves);
  EXPECT_LT(energies(w).balance.elastic, 1e-9 * moves);
  const double torque = 2e4 * body.inertia;
  EXPECT_NEAR(probe(w, {"", "tool", "angular_momentum_z", "sum"}) -
                  body.mass * cross(body.centre + w.time * Vec2{5.0, -2.0}, Vec2{5.0, -2.0}),
              torque, 1e-6 * torque);
}

/// Tables over time: a force and a torque that grow from zero, F t^3/(6 M T), and their work.
TEST(RigidBodies, follow_tables_of_force_and_torque) {
  constexpr double force = 3e5, torque = 4e3, grows = 2e-4;
  fdem::testing::Scene s = plate();
  fdem::SupportConfig& tool = s.config.supports[0];
  tool.force.times = tool.torque.times = {0.0, grows};
  tool.force.values = {Vec2{}, Vec2{force, 0.0}};
  tool.torque.values = {0.0, torque};
  fdem::World w = s.world();
  const fdem::World start = w;
  const PlaneBody body = plane_body(w, 0);
  fdem::testing::run_to(w, grows);
  const double cube = w.time * w.time * w.time / (6.0 * grows);
  const double way = force * cube / body.mass, angle = torque * cube / body.inertia;
  EXPECT_NEAR(plane_body(w, 0).centre.x - body.centre.x, way, 2e-3 * way);
  EXPECT_NEAR(angle_since(start, w, 0), angle, 2e-3 * angle);
  foresee_motions(w);
  EXPECT_LT(energies(w).balance.error_relative, 1e-5);
}

/// A body at rest that nothing is near to steps as it will once it moves: its first steps are no
/// longer than the others, and no energy is missing.
template <class World>
void expect_steps_of_one_length(World& w) {
  const double first = w.next_dt;
  EXPECT_LT(first, 1e-5);
  for (int k = 0; k < 20; ++k) step(w);
  EXPECT_NEAR(w.next_dt, first, 0.1 * first);
  foresee_motions(w);
  EXPECT_LT(energies(w).balance.error_relative, 1e-7);
}
TEST(RigidBodies, step_from_rest_as_when_they_move) {
  fdem::testing::Scene s = plate();
  s.config.time.max_step = 1e-3;
  s.config.supports[0].force = Vec2{3e3, 0.0};
  fdem::World w = s.world();
  expect_steps_of_one_length(w);
}

/// Directions that are not free go as they are told.
TEST(RigidBodies, keep_the_velocity_of_what_is_not_free) {
  fdem::testing::Scene s = plate();
  s.config.supports[0].free = {"y"};
  s.config.supports[0].velocity = Vec2{4.0, 0.0};
  s.config.supports[0].force = Vec2{1e6, 1e5};
  fdem::World w = s.world();
  const PlaneBody body = plane_body(w, 0);
  fdem::testing::run_to(w, 1e-4);
  const Vec2 way{4.0 * w.time, 0.5 * w.time * w.time * 1e5 / body.mass};
  EXPECT_LT(norm(plane_body(w, 0).centre - body.centre - way), 1e-9 * norm(way));
}

/// A body that flies as a whole begins with that only along what is free: the ledger starts there.
TEST(RigidBodies, begin_with_what_they_are_told_along_the_rest) {
  fdem::testing::Scene s = plate();
  s.config.supports[0].free = {"y"};
  for (Vec2& velocity : s.model.velocity) velocity = {3.0, -2.0};
  fdem::World w = s.world();
  const double moves = 0.5 * plane_body(w, 0).mass * 4.0;
  EXPECT_NEAR(energies(w).balance.kinetic, moves, 1e-9 * moves);
  fdem::testing::run_to(w, 1e-5);
  foresee_motions(w);
  EXPECT_NEAR(energies(w).balance.kinetic, moves, 1e-6 * moves);
  EXPECT_LT(energies(w).balance.error_relative, 1e-9);
}

/// Without "turn" a push beside the centre moves it, and does not turn it.
TEST(RigidBodies, do_not_turn_unless_they_may) {
  fdem::testing::Scene s = plate();
  s.config.supports[0].free = {"x", "y"};
  fdem::LoadConfig& push =
      s.load("push", "pressure", {0.0199, -fdem::testing::far}, {fdem::testing::far, -0.0299});
  push.pressure = 1e6;
  fdem::World w = s.world();
  const fdem::World start = w;
  const PlaneBody body = plane_body(w, 0);
  fdem::testing::run_to(w, 1e-4);
  EXPECT_GT(norm(plane_body(w, 0).centre - body.centre), 1e-6);
  EXPECT_NEAR(angle_since(start, w, 0), 0.0, 1e-12);
}

/// On a floor with friction mu, under gravity aslant: g_x - mu g_y.
TEST(RigidBodies, slide_down_a_slope) {
  fdem::testing::Scene s;
  s.material().friction = 0.4;
  s.config.time.max_step = 2e-7;
  const double depth = 1e-9;  // it stands in balance from the start
  s.body("block", prepare::crossed_rectangle({{0.0, 0.01 - depth}, {0.04, 0.02}}, 0.01));
  s.body("floor", prepare::crossed_rectangle({{0.05, -0.01}, {0.2, 0.02}}, 0.02));
  s.support("floor", {-fdem::testing::far, -fdem::testing::far},
            {fdem::testing::far, fdem::testing::far}, {"x", "y"}, {}, "floor");
  s.support("block", {-fdem::testing::far, -fdem::testing::far},
            {fdem::testing::far, fdem::testing::far}, {"x", "y"}, {}, "block")
      .free = plane_free;
  s.config.gravity = Vec2{1e4, -1e4};
  fdem::World w = s.world();
  const PlaneBody body = plane_body(w, 0);
  fdem::testing::run_to(w, 2e-3);
  const double way = 0.5 * w.time * w.time * (1e4 - 0.4 * 1e4);
  EXPECT_NEAR(plane_body(w, 0).centre.x - body.centre.x, way, 0.01 * way);
  foresee_motions(w);
  EXPECT_LT(energies(w).balance.error_relative, 1e-2);
}

/// A column on one of its corners, without friction, tips over where it stands: its centre falls
/// straight down, (J + M R^2 sin^2 q) q'' = M R sin q (g - R cos q q'^2).
TEST(RigidBodies, tip_over_an_edge) {
  const double side = 0.02, height = 0.06, tilt = 0.05, gravity = 1e4;
  const double lean = std::atan(side / height);
  fdem::testing::Scene s;
  s.material();
  s.config.time.max_step = 2e-7;
  prepare::Mesh column =
      prepare::crossed_rectangle({{0.5 * side, 0.5 * height}, {side, height}}, 0.01);
  // Its foot at the origin, its centre over it but for the tilt.
  for (Vec2& x : column.point) x = fdem::testing::rotated(x, lean - tilt);
  s.body("column", column);
  s.body("floor", prepare::crossed_rectangle({{0.0, -0.01}, {0.1, 0.02}}, 0.02));
  s.support("floor", {-fdem::testing::far, -fdem::testing::far},
            {fdem::testing::far, fdem::testing::far}, {"x", "y"}, {}, "floor");
  s.support("column", {-fdem::testing::far, -fdem::testing::far},
            {fdem::testing::far, fdem::testing::far}, {"x", "y"}, {}, "column")
      .free = plane_free;
  s.config.gravity = Vec2{0.0, -gravity};
  fdem::World w = s.world();
  const fdem::World start = w;
  const PlaneBody body = plane_body(w, 0);
  const double arm = norm(body.centre), inertia = body.inertia / body.mass;
  fdem::testing::run_to(w, 2.6e-3);
  double angle = std::atan2(body.centre.x, body.centre.y), speed = 0.0;
  EXPECT_NEAR(angle, tilt, 1e-9);
  const double dt = 1e-7;
  for (double time = 0.0; time < w.time; time += dt) {
    const double sine = std::sin(angle), cosine = std::cos(angle);
    speed += dt * arm * sine * (gravity - arm * cosine * speed * speed) /
             (inertia + arm * arm * sine * sine);
    angle += dt * speed;
  }
  EXPECT_GT(angle - tilt, 0.2);
  EXPECT_NEAR(-angle_since(start, w, 0), angle - tilt, 0.03 * (angle - tilt));
  EXPECT_NEAR(plane_body(w, 0).centre.x, body.centre.x, 1e-9);
  foresee_motions(w);
  EXPECT_LT(energies(w).balance.error_relative, 1e-6);
}

/// A rigid block hits an elastic one beside its middle: momentum and spin stay.
TEST(RigidBodies, share_their_momentum_with_what_they_hit) {
  fdem::testing::Scene s;
  s.material();
  s.body("rigid", prepare::crossed_rectangle({{0.0, 0.0}, {0.02, 0.02}}, 0.01), 0, {0.0, -10.0});
  s.body("soft", prepare::crossed_rectangle({{0.012, -0.0201}, {0.04, 0.02}}, 0.01));
  s.support("tool", {-fdem::testing::far, -fdem::testing::far},
            {fdem::testing::far, fdem::testing::far}, {"x", "y"}, {}, "rigid")
      .free = plane_free;
  fdem::World w = s.world();
  const fdem::testing::Momentum before = fdem::testing::momentum(w);
  EXPECT_GT(before.size, 1.0);  // it has the velocity of its body
  fdem::testing::run_to(w, 2e-4);
  const fdem::testing::Momentum after = fdem::testing::momentum(w);
  EXPECT_GT(probe(w, {"", "soft", "momentum_y", "sum"}), -0.99 * before.size);
  EXPECT_LT(probe(w, {"", "soft", "momentum_y", "sum"}), -0.1 * before.size);
  EXPECT_LT(norm(after.linear - before.linear), 1e-11 * before.size);
  EXPECT_NEAR(after.angular, before.angular, 1e-5 * 0.02 * before.size);
  foresee_motions(w);
  EXPECT_LT(energies(w).balance.error_relative, 1e-3);
}

fdem3::testing::Scene brick(double edge = 0.01) {
  fdem3::testing::Scene s;
  s.material();
  s.config.time.max_step = 2e-7;
  s.body("brick", prepare::kuhn_box({0.01, 0.0, 0.0}, {0.06, 0.04, 0.02}, edge), {});
  s.support("tool", {-fdem3::testing::far, -fdem3::testing::far, -fdem3::testing::far},
            {fdem3::testing::far, fdem3::testing::far, fdem3::testing::far}, {"x", "y", "z"})
      .free = all_free;
  return s;
}
struct SolidBody {
  double mass = 0.0;
  Vec3 centre{};
  Mat3 inertia{};  ///< about the centre
};
SolidBody solid_body(const fdem3::World& w) {
  SolidBody body;
  const auto each = [&](const auto& visit) {
    for (Index t = 0; t < w.tetrahedra.size(); ++t)
      for (const auto& n : w.tetrahedra.nodes.data()[t].at)
        visit(w.tetrahedra.mass.data()[t], n.position);
  };
  each([&](double m, const Vec3& x) { body.mass += m, body.centre += m * x; });
  body.centre = (1.0 / body.mass) * body.centre;
  each([&](double m, const Vec3& x) {
    const Vec3 r = x - body.centre;
    const double all = dot(r, r);
    body.inertia.a += m * (Vec3{all, 0.0, 0.0} - r.x * r);
    body.inertia.b += m * (Vec3{0.0, all, 0.0} - r.y * r);
    body.inertia.c += m * (Vec3{0.0, 0.0, all} - r.z * r);
  });
  return body;
}

/// A free body by Euler's equations, J w' = -w x J w in its axes, by steps of dt.
struct Tumbling {
  Mat3 inertia, over;
  double each;
  Vec3 spin, x{1.0, 0.0, 0.0}, y{0.0, 1.0, 0.0};
  double time = 0.0;

  Tumbling(const Mat3& j, const Vec3& begins)
      : inertia(j), over(cofactors(j)), each(1.0 / determinant(j)), spin(begins) {}
  Vec3 rate(const Vec3& v) const { return each * (over * (-1.0 * cross(v, inertia * v))); }
  void step(double dt) {
    const Vec3 middle = spin + (0.5 * dt) * rate(spin);
    const Vec3 z = cross(x, y), about = middle.x * x + middle.y * y + middle.z * z;
    spin = spin + dt * rate(middle);
    x = fdem_shared::turned(x, dt * about);
    y = fdem_shared::turned(y, dt * about);
    time += dt;
  }
};

/// About its middle axis a brick tumbles: angular momentum and energy stay, and it lies as Euler's
/// equations say.
TEST(RigidBodies, tumble_by_eulers_equations) {
  fdem3::testing::Scene s = brick(0.02);
  const Vec3 spin{300.0, 8e3, 180.0};
  s.config.supports[0].velocity = Vec3{1.0, 2.0, 3.0};
  s.config.supports[0].spin = spin;
  fdem3::World w = s.world();
  const SolidBody body = solid_body(w);
  begin_ledger(w);
  foresee_motions(w);
  const fdem3::testing::Motions before = fdem3::testing::motions(w);
  const double moves = energies(w).balance.kinetic;
  EXPECT_NEAR(moves, 0.5 * body.mass * 14.0 + 0.5 * dot(spin, body.inertia * spin), 1e-9 * moves);
  Tumbling until(body.inertia, spin), wanted = until;
  while (until.y.y > 0.3 && until.time < 1e-2) until.step(1e-7);
  ASSERT_LT(until.time, 1e-2);  // it turns over
  while (w.time < until.time) step(w);
  while (wanted.time < w.time) wanted.step(2e-8);
  EXPECT_LT(norm(w.rigid[0].turn.x - wanted.x), 5e-3);
  EXPECT_LT(norm(w.rigid[0].turn.y - wanted.y), 5e-3);
  foresee_motions(w);
  const fdem3::testing::Motions after = fdem3::testing::motions(w);
  EXPECT_LT(norm(after.linear - before.linear), 1e-10 * norm(before.linear));
  const Vec3 of_spin = before.angular - cross(body.centre, before.linear);
  const Vec3 centre = solid_body(w).centre;
  EXPECT_LT(norm(after.angular - cross(centre, after.linear) - of_spin), 1e-5 * norm(of_spin));
  EXPECT_NEAR(energies(w).balance.kinetic, moves, 1e-5 * moves);
  EXPECT_LT(energies(w).balance.elastic, 1e-8 * moves);
  EXPECT_LT(energies(w).balance.error_relative, 1e-6);
}

/// Force and torque in space, from rest: F t^2/(2 M), and L = T t.
TEST(RigidBodies, go_by_force_and_torque_in_space) {
  fdem3::testing::Scene s = brick();
  const Vec3 force{2e3, -1e3, 3e3}, torque{0.0, 0.0, 20.0};
  s.config.supports[0].force = force;
  s.config.supports[0].torque = torque;
  fdem3::World w = s.world();
  const SolidBody body = solid_body(w);
  while (w.time < 3e-4) step(w);
  const Vec3 way = (0.5 * w.time * w.time / body.mass) * force;
  EXPECT_LT(norm(solid_body(w).centre - body.centre - way), 1e-9 * norm(way));
  foresee_motions(w);
  const fdem3::testing::Motions after = fdem3::testing::motions(w);
  const Vec3 spin = after.angular - cross(solid_body(w).centre, after.linear);
  EXPECT_LT(norm(spin - w.time * torque), 1e-6 * norm(w.time * torque));
  EXPECT_LT(energies(w).balance.error_relative, 1e-6);
}

TEST(RigidBodies, step_from_rest_as_when_they_move_in_space) {
  fdem3::testing::Scene s = brick();
  s.config.time.max_step = 1e-3;
  s.config.supports[0].force = Vec3{30.0, 0.0, 0.0};
  fdem3::World w = s.world();
  expect_steps_of_one_length(w);
}

/// A rigid cube falls aslant on an elastic one: momentum and spin stay.
TEST(RigidBodies, share_their_momentum_in_space) {
  fdem3::testing::Scene s;
  s.material().friction = 0.5;
  s.body("low", fdem3::testing::box({0.0, 0.0, -0.0101}, {0.02, 0.02, 0.02}, 0.01), {});
  s.body("high", fdem3::testing::box({0.006, 0.002, 0.0101}, {0.02, 0.02, 0.02}, 0.01),
         {1.0, 0.0, -10.0});
  fdem3::SupportConfig& tool =
      s.support("tool", {-fdem3::testing::far, -fdem3::testing::far, -fdem3::testing::far},
                {fdem3::testing::far, fdem3::testing::far, fdem3::testing::far}, {"x", "y", "z"});
  tool.region.on = "high";
  tool.free = all_free;
  fdem3::World w = s.world();
  foresee_motions(w);
  const fdem3::testing::Motions before = fdem3::testing::motions(w);
  while (w.time < 1e-4) step(w);
  foresee_motions(w);
  const fdem3::testing::Motions after = fdem3::testing::motions(w);
  EXPECT_LT(probe(w, {"", "low", "momentum_z", "sum"}), -0.1 * before.size);
  EXPECT_LT(norm(after.linear - before.linear), 1e-10 * before.size);
  EXPECT_LT(norm(after.angular - before.angular), 1e-5 * 0.02 * before.size);
  EXPECT_GT(norm(w.rigid[0].angular), 0.0);
  EXPECT_LT(energies(w).balance.error_relative, 1e-3);
}

/// Half of an element, or what moves as one with the rest, cannot go by itself.
TEST(RigidBodies, are_whole_bodies) {
  fdem::testing::Scene s = plate();
  s.config.supports[0].region.max = {0.012, fdem::testing::far};
  EXPECT_THROW(s.world(), InputError);
}

}  // namespace rigid_bodies_test
}  // namespace breccia
