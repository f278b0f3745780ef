// Walls with mass that turn: inertia of their shapes, Euler's equations, hits beside the centre.

#include <gtest/gtest.h>

#include "dem/free_walls.hpp"
#include "dem/observe.hpp"
#include "dem/setup/mass_spread.hpp"
#include "exec/error.hpp"
#include "physics/dem/meshes.hpp"
#include "physics/dem/scene.hpp"
#include "prepare/checks/check_case.hpp"

namespace breccia::dem {
namespace turning_walls_test {

using testing::Scene;
using testing::state;
using testing::velocity_now;

WallConfig solid(const char* shape) {
  WallConfig w;
  w.name = "wall";
  w.shape = shape;
  w.free = {"x", "y", "z", "turn"};
  return w;
}

double read(const World& w, const char* quantity) {
  ProbeConfig probe;
  probe.name = probe.on = "wall";
  probe.quantity = quantity;
  return dem::probe(w, probe);
}
Vec3 read3(const World& w, const std::string& quantity) {
  return {read(w, (quantity + "_x").c_str()), read(w, (quantity + "_y").c_str()),
          read(w, (quantity + "_z").c_str())};
}

TEST(MassSpread, IsThatOfTheSolid) {
  const double m = 3.0, r = 0.2, h = 0.5;
  WallConfig cone = solid("cylinder");
  cone.radius = r, cone.length = h, cone.nose = "cone", cone.nose_length = h;
  const MassSpread of_cone = mass_spread(cone, m, {});
  EXPECT_NEAR(of_cone.offset.z, 0.75 * h, 1e-9);
  EXPECT_NEAR(of_cone.inertia.zz, 0.3 * m * r * r, 1e-9);
  EXPECT_NEAR(of_cone.inertia.xx, 3.0 / 80.0 * m * (4.0 * r * r + h * h), 1e-9);
  WallConfig ball = solid("cylinder");  // half of one
  ball.radius = r, ball.length = r, ball.nose = "hemisphere";
  const MassSpread half = mass_spread(ball, m, {});
  EXPECT_NEAR(half.offset.z, 0.625 * r, 1e-9);
  EXPECT_NEAR(half.inertia.zz, 0.4 * m * r * r, 1e-9);
  EXPECT_NEAR(half.inertia.xx, 83.0 / 320.0 * m * r * r, 1e-9);
  WallConfig rod = solid("cylinder");
  rod.radius = r, rod.length = h;
  const MassSpread of_rod = mass_spread(rod, m, {});
  EXPECT_NEAR(of_rod.offset.z, 0.5 * h, 1e-12);
  EXPECT_NEAR(of_rod.inertia.zz, 0.5 * m * r * r, 1e-12);
  EXPECT_NEAR(of_rod.inertia.yy, m * (3.0 * r * r + h * h) / 12.0, 1e-12);
  WallConfig sphere = solid("sphere");
  sphere.radius = r;
  EXPECT_NEAR(mass_spread(sphere, m, {}).inertia.yy, 0.4 * m * r * r, 1e-12);
  // A bullet of half a ball and a rod, put together by hand.
  WallConfig bullet = ball;
  bullet.length = r + h;
  const double of_half = 2.0 / 3.0 * pi * r * r * r, of_all = of_half + pi * r * r * h;
  const double centre = (of_half * 0.625 * r + (of_all - of_half) * (r + 0.5 * h)) / of_all;
  EXPECT_NEAR(mass_spread(bullet, m, {}).offset.z, centre, 1e-9);
}

/// A block of triangles, anywhere and turned: as the box with its edges.
TEST(MassSpread, OfTrianglesIsThatOfWhatTheyEnclose) {
  const double m = 2.0;
  const Vec3 low{0.1, -0.2, 0.3}, high{0.3, 0.3, 0.4}, size = high - low;
  const std::vector<Vec3> corners = testing::box_mesh(low, high, 2);
  ASSERT_NEAR(enclosed_volume(corners), size.x * size.y * size.z, 1e-15);
  const MassSpread s = mass_spread(solid("stl"), m, corners);
  EXPECT_LT(norm(s.offset + 0.5 * (low + high)), 1e-14);
  EXPECT_NEAR(s.inertia.xx, m / 12.0 * (size.y * size.y + size.z * size.z), 1e-14);
  EXPECT_NEAR(s.inertia.yy, m / 12.0 * (size.x * size.x + size.z * size.z), 1e-14);
  EXPECT_NEAR(s.inertia.zz, m / 12.0 * (size.y * size.y + size.x * size.x), 1e-14);
  EXPECT_NEAR(s.inertia.xy, 0.0, 1e-15);
  // Turned by 30 degrees about z: J_xy = (J_xx - J_yy) sin 60 / 2.
  const double c = std::cos(pi / 6.0), t = std::sin(pi / 6.0);
  std::vector<Vec3> askew = corners;
  for (Vec3& x : askew) x = {c * x.x - t * x.y, t * x.x + c * x.y, x.z};
  const MassSpread turned = mass_spread(solid("stl"), m, askew);
  EXPECT_NEAR(turned.inertia.xy, (s.inertia.xx - s.inertia.yy) * c * t, 1e-14);
  const Vec3 v{0.3, -1.0, 0.7};
  EXPECT_LT(norm(turned.inverse * (turned.inertia * v) - v), 1e-12);
}

/// One ball far away, so that there is a case, and the wall that is asked for.
Scene alone(const WallConfig& wall) {
  Scene s;
  s.material("ball", "grain", 1e9, 0.2, 2500.0);
  s.config.contact.friction = 0.0;
  s.sphere({5.0, 5.0, 5.0}, 0.01);
  s.config.walls = {wall};
  return s;
}

/// Turns about L at |L| / J_across: the axis of a symmetric top goes around on a cone.
TEST(TurningWalls, PrecessAsASymmetricTopDoes) {
  WallConfig rod = solid("cylinder");
  rod.radius = 0.05, rod.length = 0.04;
  rod.point = {0.0, 0.0, 0.02};  // its centre is the origin
  rod.mass = 2.0;
  rod.spin = {20.0, 0.0, 30.0};
  rod.velocity = {0.3, 0.0, 0.0};
  Scene s = alone(rod);
  s.config.time.max_step = 1e-4;
  World w = s.world();
  const double across = 2.0 * (3.0 * 0.0025 + 0.0016) / 12.0, about = 0.5 * 2.0 * 0.0025;
  const Vec3 l{20.0 * across, 0.0, 30.0 * about}, axis = (1.0 / norm(l)) * l, start{0.0, 0.0, 1.0};
  const double energy = read(w, "kinetic");
  EXPECT_NEAR(energy, 0.5 * (across * 400.0 + about * 900.0 + 2.0 * 0.09), 1e-12);
  while (w.time < 0.5) step(w);
  const double turn = norm(l) / across * w.time;
  const Vec3 aside = start - dot(start, axis) * axis;
  const Vec3 there =
      dot(start, axis) * axis + std::cos(turn) * aside + std::sin(turn) * cross(axis, aside);
  EXPECT_GT(turn, 10.0);
  EXPECT_LT(norm(w.walls[0].normal - there), 1e-4 * turn);
  EXPECT_LT(norm(w.walls[0].point - 0.02 * w.walls[0].normal - 0.3 * w.time * Vec3{1.0, 0.0, 0.0}),
            1e-12);
  const Vec3 centre{0.3 * w.time, 0.0, 0.0};
  EXPECT_LT(norm(read3(w, "angular_momentum") - l - 2.0 * cross(centre, Vec3{0.3, 0.0, 0.0})),
            1e-14);
  EXPECT_NEAR(read(w, "kinetic"), energy, 1e-9 * energy);
  EXPECT_LT(balance(w).error_relative, 1e-9);
}

/// Euler's equations J w' = -w x J w in the frame of the body, by Runge and Kutta's method with a
/// twentieth of the step, for a box that turns about its middle axis and tumbles.
TEST(TurningWalls, TumbleAsEulersEquationsSay) {
  WallConfig box = solid("box");
  box.size = {0.1, 0.06};
  box.length = 0.02;
  box.along = {1.0, 0.0, 0.0};
  box.point = {0.0, 0.0, 0.01};
  box.mass = 1.0;
  box.spin = {0.3, 40.0, 0.5};
  Scene s = alone(box);
  s.config.time.max_step = 5e-5;
  World w = s.world();
  const Vec3 j{(0.06 * 0.06 + 0.0004) / 12.0, (0.01 + 0.0004) / 12.0, (0.01 + 0.06 * 0.06) / 12.0};
  struct Body {
    Vec3 spin, x, z;  // its own frame; two of its axes in the case
  };
  const auto rate = [&](const Body& b) {
    const Vec3 l{j.x * b.spin.x, j.y * b.spin.y, j.z * b.spin.z}, t = cross(l, b.spin);
    const Vec3 in_case = b.spin.x * b.x + b.spin.y * cross(b.z, b.x) + b.spin.z * b.z;
    return Body{{t.x / j.x, t.y / j.y, t.z / j.z}, cross(in_case, b.x), cross(in_case, b.z)};
  };
  const auto plus = [](const Body& b, double by, const Body& d) {
    return Body{b.spin + by * d.spin, b.x + by * d.x, b.z + by * d.z};
  };
  Body body{box.spin.value, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  const Vec3 l = read3(w, "angular_momentum");
  const double energy = read(w, "kinetic");
  double flipped = 1.0;
  while (w.time < 0.6) {
    step(w);
    const double h = w.last_dt / 20.0;
    for (int k = 0; k < 20; ++k) {
      const Body a = rate(body), b = rate(plus(body, 0.5 * h, a)), c = rate(plus(body, 0.5 * h, b)),
                 d = rate(plus(body, h, c));
      body = plus(plus(plus(plus(body, h / 6.0, a), h / 3.0, b), h / 3.0, c), h / 6.0, d);
    }
    flipped = std::min(flipped, body.spin.y / 40.0);
  }
  EXPECT_LT(flipped, -0.9) << "it has tumbled";
  EXPECT_LT(norm(w.walls[0].normal - body.z), 5e-3);
  EXPECT_LT(norm(w.walls[0].along - body.x), 5e-3);
  EXPECT_LT(norm(read3(w, "angular_momentum") - l), 1e-13);
  EXPECT_NEAR(read(w, "kinetic"), energy, 1e-5 * energy);
}

constexpr double ball_mass = 4.0 / 3.0 * pi * 1e-6 * 2500.0;
/// A ball of 0.01 m hits a plate that flies free, b beside its centre.
Scene hit(double b, WallConfig wall) {
  Scene s;
  s.material("ball", "grain", 1e9, 0.2, 2500.0);
  s.config.contact.friction = 0.0;
  s.config.time.safety = 0.02;
  s.sphere({b, 0.0, 0.0101}, 0.01, {0.0, 0.0, -1.5});
  s.config.walls = {std::move(wall)};
  return s;
}
WallConfig plate() {
  WallConfig w = solid("box");
  w.size = {0.1, 0.06};
  w.length = 0.02;
  w.along = {1.0, 0.0, 0.0};
  w.mass = 0.02;
  return w;
}

/// Without friction and loss the push is 2 v / (1/m + 1/M + b^2 / J).
TEST(TurningWalls, ThatAreHitBesideTheirCentreTurnAsTheirInertiaSays) {
  const double inertia = 0.02 * (0.01 + 0.0004) / 12.0;
  for (const bool hertz : {false, true})
    for (const double b : {0.0, 0.015, 0.035}) {
      Scene s = hit(b, plate());
      if (hertz) s.config.contact.law = "hertz";
      World w = s.world();
      const auto all = [&] {
        return read3(w, "angular_momentum") +
               ball_mass * cross(state(w, 0).position, velocity_now(w, 0));
      };
      const Vec3 before = all();
      double missed = 0.0;
      while (w.time < 1e-3) {
        step(w);
        missed = std::max(missed, balance(w).error_relative);
        const Vec3 p = read3(w, "momentum") + ball_mass * velocity_now(w, 0);
        ASSERT_LT(norm(p - Vec3{0.0, 0.0, -1.5 * ball_mass}), 1e-12 * ball_mass);
        ASSERT_LT(norm(all() - before), 1e-7 * ball_mass) << w.step;
      }
      const double push = 3.0 / (1.0 / ball_mass + 1.0 / 0.02 + b * b / inertia);
      EXPECT_NEAR(state(w, 0).velocity.z, -1.5 + push / ball_mass, 5e-3) << b << hertz;
      EXPECT_NEAR(read(w, "velocity_z"), -push / 0.02, 5e-3) << b << hertz;
      EXPECT_NEAR(w.walls[0].spin.y, b * push / inertia, 5e-3 * push / inertia * 0.035 + 1e-9)
          << b << hertz;
      EXPECT_LT(std::abs(w.walls[0].spin.x) + std::abs(w.walls[0].spin.z), 1e-9);
      EXPECT_LT(missed, 1e-2) << b << hertz;
      EXPECT_LT(balance(w).error_relative, 2e-3) << b << hertz;
      EXPECT_EQ(balance(w).work, 0.0);
    }
}

/// Told not to turn, the plate is that of before.
TEST(TurningWalls, ThatMayNotTurnDoNot) {
  WallConfig still = plate();
  still.free = {"x", "y", "z"};
  World w = hit(0.035, still).world();
  while (w.time < 1e-3) step(w);
  const double push = 3.0 / (1.0 / ball_mass + 1.0 / 0.02);
  EXPECT_NEAR(read(w, "velocity_z"), -push / 0.02, 5e-3);
  EXPECT_EQ(norm(w.walls[0].spin), 0.0);
}

/// With friction and a dashpot: what the ball loses of its spin and momentum the wall gains, and
/// the ledger closes with what rubbing and damping took.
TEST(TurningWalls, KeepMomentaAndEnergyWithFriction) {
  Scene s = hit(0.02, plate());
  s.config.contact.friction = 0.4;
  s.config.contact.restitution = 0.7;
  s.model.velocity[0] = {0.8, 0.3, -1.5};
  s.model.spin[0] = {0.0, -60.0, 20.0};
  World w = s.world();
  const double turn = 0.4 * ball_mass * 1e-4;
  const auto all = [&] {
    const ElementState& ball = state(w, 0);
    const Vec3 spin = ball.spin + (0.5 * w.last_dt / turn) * w.elements.torque.data()[0];
    return read3(w, "angular_momentum") + turn * spin +
           ball_mass * cross(ball.position, velocity_now(w, 0));
  };
  const Vec3 before = all();
  double missed = 0.0;
  while (w.time < 1e-3) {
    step(w);
    missed = std::max(missed, balance(w).error_relative);
  }
  EXPECT_LT(norm(all() - before), 1e-6 * norm(before));
  EXPECT_GT(balance(w).friction, 1e-3 * balance(w).start);
  EXPECT_GT(norm(w.walls[0].spin), 1.0);
  EXPECT_LT(missed, 1e-2);
  EXPECT_LT(balance(w).error_relative, 2e-3);
}

/// A plate of triangles with its origin at a corner is the plate.
TEST(TurningWalls, OfTrianglesTurnAsTheBoxTheyEnclose) {
  WallConfig mesh = solid("stl");
  mesh.file = "plate.stl";
  mesh.point = {-0.05, -0.03, 0.0};
  mesh.mass = 0.02;
  Scene s = hit(0.035, mesh);
  s.model.wall_meshes = {testing::box_mesh({0.0, 0.0, -0.02}, {0.1, 0.06, 0.0}, 2)};
  World w = s.world();
  World box = hit(0.035, plate()).world();
  while (w.time < 1e-3) step(w);
  while (box.time < w.time) step(box);
  EXPECT_GT(norm(box.walls[0].spin), 1.0);
  EXPECT_LT(norm(w.walls[0].spin - box.walls[0].spin), 1e-3 * norm(box.walls[0].spin));
  EXPECT_NEAR(read(w, "velocity_z"), read(box, "velocity_z"), 1e-5);
  EXPECT_LT(norm(w.walls[0].normal - box.walls[0].normal), 1e-5);
}

TEST(TurningWalls, AreRefusedWhereTheyHaveNoInertia) {
  const auto expect = [](const char* text, const auto& change) {
    Config config = hit(0.0, plate()).config;
    change(config.walls[0], config);
    try {
      check_case(config);
      FAIL() << text;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << text << "\n" << e.what();
    }
  };
  expect("wall.wall.free: a plane has no end and no inertia", [](auto& w, auto&) {
    w.shape = "plane";
    w.size = {};
    w.length = 0.0;
    w.along = {};
  });
  expect("wall.wall.spin: a wall with mass turns only where free names turn", [](auto& w, auto&) {
    w.free = {"x"}, w.spin = {0.0, 0.0, 1.0};
  });
  expect("wall.wall.free: normal stands alone", [](auto& w, auto&) {
    w.free = {"normal", "turn"};
  });
  expect("wall.wall.free: contacts bear no moments on a wall that turns",
         [](auto&, Config& config) { config.contact.rolling_stiffness = 1.0; });
  expect("is of walls with mass that turn", [](auto& w, Config& config) {
    w.free = {"x", "y", "z"};
    ProbeConfig p;
    p.name = "p";
    p.on = "wall";
    p.quantity = "angular_momentum_x";
    config.probes = {p};
  });
}

}  // namespace turning_walls_test
}  // namespace breccia::dem
