// Walls with ends and turning walls: nearest points, bounces and friction by closed answers, the
// ledger, and the same bits by a device's schedule and on ranks.

#include <gtest/gtest.h>

#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "dem/setup/walls.hpp"
#include "domain/simulated_ranks.hpp"
#include "physics/dem/scene.hpp"

namespace breccia::dem {
namespace wall_shapes_test {

using testing::Scene;

WallConfig cylinder() {
  WallConfig w;
  w.name = "wall";
  w.shape = "cylinder";
  w.normal = {0.0, 0.0, 2.0};
  w.radius = 2.0;
  w.length = 3.0;
  return w;
}
WallConfig box() {
  WallConfig w;
  w.name = "wall";
  w.shape = "box";
  w.normal = {0.0, 0.0, 1.0};
  w.along = {1.0, 0.0, 5.0};
  w.size = {4.0, 2.0};
  w.length = 3.0;
  return w;
}
/// A cylinder of radius 2 whose tip points up.
WallConfig nosed(const char* nose, double nose_length) {
  WallConfig w = cylinder();
  w.length = 8.0;
  w.nose = nose;
  w.nose_length = nose_length;
  return w;
}
void expect_touch(const WallConfig& config, const Vec3& x, const Vec3& normal, double height) {
  const WallTouch at = touch(wall_of(config, {}), x);
  EXPECT_LT(norm(at.normal - normal), 1e-12) << x.x << " " << x.y << " " << x.z;
  EXPECT_NEAR(at.height, height, 1e-12);
}

TEST(WallShapes, are_nearest_at_faces_edges_and_corners) {
  expect_touch(cylinder(), {1.0, 0.5, 0.7}, {0.0, 0.0, 1.0}, 0.7);
  expect_touch(cylinder(), {0.0, 2.5, -1.0}, {0.0, 1.0, 0.0}, 0.5);
  expect_touch(cylinder(), {2.3, 0.0, 0.4}, {0.6, 0.0, 0.8}, 0.5);
  expect_touch(cylinder(), {0.5, 0.0, -3.2}, {0.0, 0.0, -1.0}, 0.2);
  expect_touch(cylinder(), {0.0, -1.9, -1.5}, {0.0, -1.0, 0.0}, -0.1);
  expect_touch(cylinder(), {0.0, 0.3, -0.2}, {0.0, 0.0, 1.0}, -0.2);
  expect_touch(box(), {1.0, 0.5, 0.7}, {0.0, 0.0, 1.0}, 0.7);
  expect_touch(box(), {2.5, 0.5, -1.0}, {1.0, 0.0, 0.0}, 0.5);
  expect_touch(box(), {0.0, -1.3, 0.4}, {0.0, -0.6, 0.8}, 0.5);
  expect_touch(box(), {-4.0, 3.0, 1.0}, {-2.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0}, 3.0);
  expect_touch(box(), {1.95, 0.0, -0.5}, {1.0, 0.0, 0.0}, -0.05);
  WallConfig sphere;
  sphere.shape = "sphere";
  sphere.point = {1.0, 0.0, 0.0};
  sphere.radius = 2.0;
  expect_touch(sphere, {1.0, 3.0, 4.0}, {0.0, 0.6, 0.8}, 3.0);
}

/// A cone of slope 3/4 (normal 0.8 outward, 0.6 ahead); a hemisphere; an ogive of radius 2 and
/// length 4 is an arc of radius (4 + 16) / 4 = 5 about a point 3 beyond the axis.
TEST(WallShapes, with_noses_are_nearest_where_geometry_says) {
  const WallConfig cone = nosed("cone", 8.0 / 3.0), ogive = nosed("ogive", 4.0);
  const WallConfig round = nosed("hemisphere", 0.0);
  const double n = 8.0 / 3.0;
  expect_touch(cone, {0.0, 0.0, 0.3}, {0.0, 0.0, 1.0}, 0.3);
  expect_touch(cone, {0.3, 0.0, 0.4}, {0.6, 0.0, 0.8}, 0.5);
  expect_touch(cone, {0.0, 1.0 + 0.8 * 0.7, -0.5 * n + 0.6 * 0.7}, {0.0, 0.8, 0.6}, 0.7);
  expect_touch(cone, {-1.0 + 0.8 * 0.2, 0.0, -0.5 * n - 0.6 * 0.2}, {-0.8, 0.0, 0.6}, -0.2);
  const Vec3 between = (1.0 / norm(Vec3{0.9, 0.0, 0.3})) * Vec3{0.9, 0.0, 0.3};
  expect_touch(cone, Vec3{2.0, 0.0, -n} + 0.4 * between, between, 0.4);
  expect_touch(cone, {2.5, 0.0, -5.0}, {1.0, 0.0, 0.0}, 0.5);
  expect_touch(cone, {0.0, -1.9, -5.0}, {0.0, -1.0, 0.0}, -0.1);
  expect_touch(round, {0.0, 0.0, 0.3}, {0.0, 0.0, 1.0}, 0.3);
  expect_touch(round, {1.8, 0.0, -2.0 + 2.4}, {0.6, 0.0, 0.8}, 1.0);
  expect_touch(round, {0.9, 0.0, -2.0 + 1.2}, {0.6, 0.0, 0.8}, -0.5);
  expect_touch(round, {0.0, 3.0, -2.5}, {0.0, 1.0, 0.0}, 1.0);
  expect_touch(ogive, {0.0, 0.0, 0.3}, {0.0, 0.0, 1.0}, 0.3);
  expect_touch(ogive, {0.6, 0.0, 0.8}, {0.6, 0.0, 0.8}, 1.0);  // steeper than the tip's 0.8, 0.6
  const double sine = 0.5, cosine = std::sqrt(0.75);
  expect_touch(ogive, {-3.0 + 5.5 * cosine, 0.0, -4.0 + 5.5 * sine}, {cosine, 0.0, sine}, 0.5);
  expect_touch(ogive, {-3.0 + 4.8 * cosine, 0.0, -4.0 + 4.8 * sine}, {cosine, 0.0, sine}, -0.2);
  for (const WallConfig& all : {cone, ogive, round}) {
    expect_touch(all, {0.5, 0.0, -8.2}, {0.0, 0.0, -1.0}, 0.2);
    expect_touch(all, {0.5, 0.0, -7.8}, {0.0, 0.0, -1.0}, -0.2);
    expect_touch(all, {2.3, 0.0, -8.4}, {0.6, 0.0, -0.8}, 0.5);
  }
}

/// Beside many places: how near the nearest of many points of the outline is.
TEST(WallShapes, with_noses_are_as_near_as_their_nearest_point) {
  for (const WallConfig& config :
       {nosed("cone", 3.0), nosed("ogive", 5.0), nosed("hemisphere", 0.0)}) {
    const bool cone = config.nose == "cone", round = config.nose == "hemisphere";
    const double nose = round ? 2.0 : config.nose_length, arc = (4.0 + nose * nose) / 4.0;
    std::vector<Vec2> outline;
    for (int i = 0; i <= 4000; ++i) {
      const double z = nose * (i / 4000.0) * (i / 4000.0);  // close together near the tip
      const double left = nose - z;
      outline.push_back(
          {z, cone ? 2.0 * z / nose : std::sqrt(arc * arc - left * left) - arc + 2.0});
      outline.push_back({nose + (8.0 - nose) * i / 4000.0, 2.0});
      outline.push_back({8.0, 2.0 * i / 4000.0});
    }
    const Wall wall = wall_of(config, {});
    for (int i = 0; i < 400; ++i) {
      const double z = -2.0 + 12.0 * (i % 20) / 19.0, r = 4.0 * (i / 20) / 19.0;
      double nearest = 1e9;
      for (const Vec2& p : outline) nearest = std::min(nearest, std::hypot(p.x - z, p.y - r));
      const WallTouch at = touch(wall, {0.6 * r, 0.8 * r, -z});
      EXPECT_GT(nearest, std::abs(at.height) - 1e-9) << z << " " << r;
      EXPECT_LT(nearest, std::hypot(at.height, 2e-3)) << z << " " << r;  // half their distance
      EXPECT_NEAR(norm(at.normal), 1.0, 1e-14);
      const Vec3 foot = Vec3{0.6 * r, 0.8 * r, -z} - at.height * at.normal;
      EXPECT_NEAR(touch(wall, foot).height, 0.0, 1e-12) << z << " " << r;
    }
  }
}

TEST(WallShapes, have_no_jumps_at_their_edges) {
  for (const char* nose : {"cone", "ogive", "hemisphere"}) {  // all around them, 0.1 away
    const Wall wall = wall_of(nosed(nose, nose[0] == 'h' ? 0.0 : 3.0), {});
    WallTouch last = touch(wall, {0.0, 0.0, 0.1});
    Vec3 x{1e-3, 0.0, 0.1};
    x += (0.1 - touch(wall, x).height) * touch(wall, x).normal;
    double turned = 0.0;
    for (int i = 0; i < 40'000 && x.x > 0.0; ++i) {
      const WallTouch now = touch(wall, x);
      EXPECT_LT(norm(now.normal - last.normal), 1.2e-2) << nose << x.x << " " << x.z;
      EXPECT_LT(std::abs(now.height - 0.1), 1e-9) << nose << x.x << " " << x.z;
      turned += norm(now.normal - last.normal);
      last = now;
      x += 1e-3 * Vec3{now.normal.z, 0.0, -now.normal.x};
      x += (0.1 - touch(wall, x).height) * touch(wall, x).normal;
    }
    EXPECT_NEAR(turned, pi, 0.01) << nose << " from tip to back";
  }
  for (const WallConfig& config : {cylinder(), box()}) {
    const Wall wall = wall_of(config, {});
    WallTouch last = touch(wall, {1.9, 0.0, 0.5});
    for (double s = 1e-4; s < 1.0; s += 1e-4) {
      const WallTouch now = touch(wall, {1.9 + 0.6 * s, 0.0, 0.5 - 1.5 * s});
      EXPECT_LT(norm(now.normal - last.normal), 2e-3) << s;
      EXPECT_LT(std::abs(now.height - last.height), 2e-4) << s;
      last = now;
    }
  }
}

TEST(WallShapes, ask_for_their_lengths) {
  WallConfig w = cylinder();
  EXPECT_TRUE(wall_problems(w).empty());
  EXPECT_TRUE(wall_problems(box()).empty());
  w.length = 0.0;
  w.size = {1.0, 1.0};
  ASSERT_EQ(wall_problems(w).size(), 2U);
  EXPECT_EQ(wall_problems(w)[0], "wall.wall.length: a cylinder needs it");
  EXPECT_EQ(wall_problems(w)[1], "wall.wall.size: a cylinder has none");
  const auto problem = [](const WallConfig& of) {
    const std::vector<std::string> all = wall_problems(of);
    return all.size() == 1 ? all[0] : std::to_string(all.size());
  };
  EXPECT_EQ(problem(nosed("cone", 3.0)), "0");
  EXPECT_EQ(problem(nosed("ogive", 2.0)), "0");
  EXPECT_EQ(problem(nosed("hemisphere", 0.0)), "0");
  EXPECT_EQ(problem(nosed("cone", 0.0)), "wall.wall.nose_length: a nose of this kind needs it");
  EXPECT_EQ(problem(nosed("flat", 1.0)), "wall.wall.nose_length: a flat end has none");
  EXPECT_NE(problem(nosed("ogive", 1.9)).find("at least as long as its radius"), std::string::npos);
  EXPECT_NE(problem(nosed("hemisphere", 2.0)).find("leave it out"), std::string::npos);
  EXPECT_NE(problem(nosed("cone", 9.0)).find("wall.wall.length counts the nose"),
            std::string::npos);
  w = box();
  w.nose = "cone";
  EXPECT_EQ(problem(w), "wall.wall.nose: only a cylinder has one");
  w = {};
  w.spin = {1.0, 0.0, 0.0};
  EXPECT_EQ(wall_problems(w).size(), 1U);
  w.spin = {0.0, 0.0, 1.0};
  EXPECT_TRUE(wall_problems(w).empty());
}

Scene thrown(const WallConfig& wall, const Vec3& from, const Vec3& velocity, double friction) {
  Scene s;
  s.material("grain", "grain", 1e9, 0.2, 2500.0);
  s.config.contact.friction = friction;
  s.sphere(from, 0.01, velocity);
  s.config.walls.push_back(wall);
  s.config.time.safety = 0.05;
  s.config.time.end = 1.0;
  return s;
}

/// Without friction a bounce turns the velocity around in the normal at the nearest point: of a
/// ball, whose centre is 0.06 m from the grain's when they touch, and of a cylinder's rim, 5 of 10
/// mm beside its face. The ledger misses about as much as at a
/// plane.
TEST(WallShapes, throw_back_along_their_normals) {
  WallConfig plane, ball, punch;
  ball.shape = "sphere";
  ball.radius = 0.05;
  punch.shape = "cylinder";
  punch.radius = 0.04;
  punch.length = 0.03;
  for (const bool hertz : {false, true}) {
    double at_plane = 0.0;
    for (const WallConfig& wall : {plane, ball, punch}) {
      const bool flat = wall.shape == "plane";
      const Vec3 from{wall.shape == "sphere" ? 0.03 : 0.045, 0.0,
                      wall.shape == "sphere" ? 0.0525
                      : flat                 ? 0.0105
                                             : 0.0092};
      Scene s = thrown(wall, from, {0.0, 0.0, -0.3}, 0.0);
      if (hertz) s.config.contact.law = "hertz";
      World w = s.world();
      double missed = 0.0;  // while they touch, too
      while (w.time < 0.01) {
        step(w);
        missed = std::max(missed, balance(w).error_relative);
      }
      const double sine = flat ? 0.0 : 0.5, cosine = std::sqrt(1.0 - sine * sine);
      const Vec3 expected = Vec3{0.0, 0.0, -0.3} + 0.6 * cosine * Vec3{sine, 0.0, cosine};
      EXPECT_LT(norm(w.elements.state.data()[0].velocity - expected), 1e-2 * 0.3) << wall.shape;
      if (flat) at_plane = missed;
      EXPECT_LT(missed, 2.0 * at_plane) << wall.shape << hertz;
      EXPECT_LT(missed, 1e-2);
    }
  }
}

/// A grain beside a platen falls past it; one above it comes back.
TEST(WallShapes, end_where_they_end) {
  WallConfig platen = cylinder();
  platen.radius = 0.1;
  platen.length = 0.05;
  for (const bool above : {true, false}) {
    Scene s = thrown(platen, {above ? 0.09 : 0.115, 0.0, 0.03}, {0.0, 0.0, -2.0}, 0.0);
    World w = s.world();
    while (w.time < 0.05) step(w);
    EXPECT_EQ(w.elements.state.data()[0].velocity.z > 0.0, above);
  }
}

/// A grain that is held on a plane that turns about its normal rubs with mu N at its distance.
TEST(WallShapes, that_turn_drag_what_lies_on_them) {
  WallConfig table;
  table.name = "table";
  table.spin = {0.0, 0.0, 20.0};
  Scene s = thrown(table, {0.05, 0.0, 0.00995}, {}, 0.4);
  SupportConfig hold;
  hold.name = "hold";
  hold.fix = {"all"};
  s.config.supports.push_back(hold);
  ProbeConfig torque, force;
  torque.name = torque.on = force.name = force.on = "table";
  torque.quantity = "torque_z";
  torque.about = {0.0, 0.0, 0.0};
  force.quantity = "force_z";
  World w = s.world();
  while (w.time < 1e-2) step(w);
  const double push = -probe(w, force);
  EXPECT_GT(push, 0.0);
  EXPECT_NEAR(probe(w, torque), -0.4 * push * 0.05, 1e-6 * push);
  const EnergyBalance e = balance(w);
  EXPECT_GT(e.friction, 0.0);
  EXPECT_NEAR(e.work, 0.4 * push * 0.05 * 20.0 * w.time, 0.02 * e.work);  // the spring first
  EXPECT_LT(e.error_relative, 2e-4);  // half a step of the first push
}

/// A flap that swings about its middle pushes grains off: all that they gain is its work.
Scene swung() {
  WallConfig flap = box();
  flap.point = {0.0, 0.0, 0.0};
  flap.size = {0.2, 0.1};
  flap.length = 0.02;
  flap.along = {1.0, 0.0, 0.0};
  flap.spin = {0.0, -30.0, 0.0};
  Scene s = thrown(flap, {0.06, 0.0, 0.0105}, {}, 0.3);
  s.sphere({-0.07, 0.01, -0.0305}, 0.01);
  s.sphere({0.03, -0.02, 0.0102}, 0.01);
  return s;
}

TEST(WallShapes, that_swing_do_the_work_that_grains_gain) {
  Scene s = swung();
  World w = s.world();
  while (w.time < 5e-3) step(w);
  const EnergyBalance e = balance(w);
  EXPECT_GT(w.elements.state.data()[0].velocity.z, 1.8 * 30.0 * 0.06);  // thrown off at twice
  EXPECT_LT(e.error_relative, 1e-4);
  EXPECT_GT(e.work, 0.9 * e.kinetic);
}

TEST(WallShapes, that_swing_are_alike_by_a_devices_schedule_and_on_ranks) {
  Scene s = swung();
  const auto run = [](World& w) {
    while (w.time < 3e-3) advance(w, {3e-3, 100'000});
  };
  World host = s.world();
  run(host);
  Exec exec;
  exec.space = Space::shadow;
  World shadow = make_world(s.config, s.model, exec);
  run(shadow);
  EXPECT_EQ(state_hash(shadow), state_hash(host));
  simulate_ranks(2, 7, [&](Communicator& ranks) {
    World whole = s.world();
    World part = share_out(whole, ranks, s.config.domain, Space::host);
    run(part);
    collect(part, whole);
    if (ranks.rank() != 0) return;
    EXPECT_EQ(state_hash(whole), state_hash(host));
  });
}

}  // namespace wall_shapes_test
}  // namespace breccia::dem
