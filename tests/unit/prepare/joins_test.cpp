// Bodies of joined boxes, spheres and cylinders.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/build.hpp"
#include "prepare/checks/check_case.hpp"
#include "prepare/shapes/solid.hpp"
#include "unit/prepare/models.hpp"

namespace breccia::prepare {
namespace joins_test {

using dem::Config;
using dem::CutConfig;
using dem::Model;

CutConfig box_of(const Vec3& center, const Vec3& size) {
  CutConfig box;
  box.center = center;
  box.size = size;
  return box;
}

/// An angle of two legs 40 mm thick and 100 mm deep: 0.12 m and 0.16 m long.
Config angle() {
  Config config = dem::case_with_materials();
  config.bodies = {dem::box_body("angle", {0.12, 0.1, 0.04}, 2500, 0.58)};
  config.bodies[0].center = {0.06, 0.0, 0.02};
  config.bodies[0].joins = {box_of({0.02, 0.0, 0.08}, {0.04, 0.1, 0.16})};
  config.links.range = 1.4;
  return config;
}
constexpr double of_angle = 0.1 * (0.12 * 0.04 + 0.16 * 0.04 - 0.04 * 0.04);

TEST(Union, HasItsVolumeAndDepth) {
  const Union whole(angle().bodies[0]);
  EXPECT_NEAR(whole.volume(), of_angle, 1e-3 * of_angle);
  EXPECT_EQ(whole.low().x, 0.0);
  EXPECT_NEAR(whole.high().z, 0.16, 1e-15);
  EXPECT_NEAR(whole.depth({0.1, 0.0, 0.02}), 0.02, 1e-12);
  EXPECT_NEAR(whole.depth({0.02, 0.0, 0.15}), 0.01, 1e-12);
  EXPECT_LT(whole.depth({0.1, 0.0, 0.1}), 0.0);
  EXPECT_TRUE(whole.parts({0.1, 0.0, 0.039}, {0.039, 0.0, 0.1}));
  EXPECT_FALSE(whole.parts({0.1, 0.0, 0.02}, {0.02, 0.0, 0.1}) &&
               whole.parts({0.02, 0.0, 0.02}, {0.02, 0.0, 0.1}));
  // Two balls whose centres are d apart: twice a ball less the lens.
  const double r = 0.05, d = 0.07;
  const auto ball = [&](double z) {
    return Solid{{.shape = Container::Shape::sphere, .size = {}, .radius = r}, {0.0, 0.0, z}, {}};
  };
  const Union balls({ball(0.0), ball(d)});
  const double lens = pi * (4.0 * r + d) * (2.0 * r - d) * (2.0 * r - d) / 12.0;
  const double expected = 8.0 / 3.0 * pi * r * r * r - lens;
  EXPECT_NEAR(balls.volume(), expected, 1e-3 * expected);
}

/// A segment through a turned cylinder, by its closed answer.
TEST(Union, KnowsWhatOfASegmentLiesInASolid) {
  const Frame3 frame = frame_of({1.0, 0.0, 0.0}, {});  // along x
  const Solid rod{{.shape = Container::Shape::cylinder, .size = {}, .radius = 0.1, .length = 1.0},
                  {0.0, 0.0, 0.0},
                  frame};
  const Solid::Span across = rod.span({0.0, -1.0, 0.06}, {0.0, 1.0, 0.06});
  EXPECT_NEAR(across.low, 0.5 - 0.04, 1e-12);  // half a chord: sqrt(0.1^2 - 0.06^2) = 0.08
  EXPECT_NEAR(across.high, 0.5 + 0.04, 1e-12);
  const Solid::Span along = rod.span({-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0});
  EXPECT_NEAR(along.low, 0.25, 1e-12);
  EXPECT_NEAR(along.high, 0.75, 1e-12);
  const Solid::Span beside = rod.span({-1.0, 0.2, 0.0}, {1.0, 0.2, 0.0});
  EXPECT_GT(beside.low, beside.high);
}

TEST(Joins, MakeOneBodyOfTheirUnion) {
  const Config config = angle();
  const Model m = build_model(config, ".");
  const Union whole(config.bodies[0]);
  EXPECT_NEAR(m.size(), 2500, 0.05 * 2500);
  for (const Vec3& x : m.position) ASSERT_GT(whole.depth(x), 0.0);
  // No link leaves the angle on its way, and many lead from leg to leg.
  int from_leg_to_leg = 0;
  for (const Model::Link& link : m.links) {
    if (link.parted) continue;
    const Vec3 a = m.position[static_cast<std::size_t>(link.a)],
               b = m.position[static_cast<std::size_t>(link.b)];
    for (const double t : {0.2, 0.4, 0.5, 0.6, 0.8}) ASSERT_GT(whole.depth(a + t * (b - a)), -1e-9);
    from_leg_to_leg += (a.z > 0.04) != (b.z > 0.04) ? 1 : 0;
  }
  EXPECT_GT(from_leg_to_leg, 50);
  const double mass = std::accumulate(m.mass.begin(), m.mass.end(), 0.0);
  EXPECT_NEAR(mass, 2400.0 * of_angle, 0.05 * mass);
}

/// Two blocks with a gap thinner than an element are two pieces.
TEST(Joins, AcrossAGapAreNotLinked) {
  Config config = dem::case_with_materials();
  config.bodies = {dem::box_body("two", {0.1, 0.1, 0.05}, 1500, 0.58)};
  config.bodies[0].joins = {box_of({0.0, 0.0, 0.0515}, {0.1, 0.1, 0.05})};
  config.links.range = 1.4;
  const Model m = build_model(config, ".");
  int across = 0, above = 0;
  for (const Model::Link& link : m.links) {
    const double a = m.position[static_cast<std::size_t>(link.a)].z,
                 b = m.position[static_cast<std::size_t>(link.b)].z;
    if (!link.parted && (a > 0.026) != (b > 0.026)) ++across;
  }
  for (const Vec3& x : m.position) above += x.z > 0.026 ? 1 : 0;
  EXPECT_EQ(across, 0);
  EXPECT_GT(above, 500);
}

/// Cut after it is joined: a hole through a lug, which turns about its own centre.
TEST(Joins, AreCutAndMoveAsOneBody) {
  Config config = angle();
  dem::BodyConfig& body = config.bodies[0];
  CutConfig hole;
  hole.shape = "cylinder";
  hole.axis = {0.0, 1.0, 0.0};
  hole.center = {0.02, 0.0, 0.12};
  hole.radius = 0.012;
  hole.length = 0.2;
  body.cuts = {hole};
  body.velocity = {1.0, 0.0, 0.0};
  body.spin = {0.0, 0.0, 2.0};
  const Model m = build_model(config, ".");
  for (std::size_t e = 0; e < m.position.size(); ++e) {
    const Vec3 x = m.position[e];
    EXPECT_GE(std::hypot(x.x - 0.02, x.z - 0.12), 0.012);
    const Vec3 v = body.velocity + cross(body.spin, x - body.center);
    EXPECT_LT(norm(m.velocity[e] - v), 1e-12);
  }
}

TEST(Joins, AreRefusedWhereTheyMakeNoBody) {
  const auto expect = [](const char* text, const std::function<void(Config&)>& change) {
    Config config = angle();
    change(config);
    try {
      dem::check_case(config);
      FAIL() << text;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << text << "\n" << e.what();
    }
  };
  expect("body.angle.join[0].size needs three lengths above 0",
         [](Config& c) { c.bodies[0].joins[0].size.y = 0.0; });
  expect("body.angle.join[0].radius must be above 0",
         [](Config& c) { c.bodies[0].joins[0].shape = "sphere"; });
  expect("body.angle.join[0]: draw the union in the STL file",
         [](Config& c) { c.bodies[0].joins[0].shape = "stl"; });
  expect("body.angle.join: boxes, spheres and cylinders are joined to", [](Config& c) {
    c.bodies[0].shape = "stl";
    c.bodies[0].file = "a.stl";
  });
  expect("body.angle.pack.periodic: a body with joins",
         [](Config& c) { c.bodies[0].pack.periodic = {"x"}; });
}

}  // namespace joins_test
}  // namespace breccia::prepare
