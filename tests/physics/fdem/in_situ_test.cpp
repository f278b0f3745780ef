// Stress in situ that grows with depth: ground at rest under its weight stays as it is.

#include <gtest/gtest.h>

#include "fdem/setup/warnings.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace in_situ_test {

using testing::far;
using testing::Scene;

constexpr double density = 2500.0, gravity = 9.81, k0 = 0.6;

/// 20 m wide and 10 m deep, on rollers; its surface is y = 0. `parts`: joints, or none.
Scene ground(const char* joints, bool graded = true) {
  Scene s;
  MaterialConfig& m = s.material(30e9, 0.2, density);
  m.joints = joints;
  m.joint.tension = 1e6;
  m.joint.cohesion = 10e6;
  m.joint.energy_open = 300.0;
  s.body("ground", prepare::crossed_rectangle({{0.0, -5.0}, {20.0, 10.0}}, 1.0));
  s.config.plane = "strain";
  s.config.gravity = {0.0, -gravity};
  if (graded) {
    s.config.in_situ.yy_slope = {0.0, density * gravity};
    s.config.in_situ.xx_slope = {0.0, k0 * density * gravity};
  } else {
    s.config.in_situ.yy = -density * gravity * 5.0;
    s.config.in_situ.xx = k0 * s.config.in_situ.yy;
  }
  s.support("left", {-far, -far}, {-9.99, far}, {"x"});
  s.support("right", {9.99, -far}, {far, far}, {"x"});
  s.support("foot", {-far, -far}, {far, -9.99}, {"y"});
  return s;
}

double stress(const World& w, const char* quantity, double y) {
  ProbeConfig p;
  p.name = p.quantity = quantity;
  p.min = {-far, y - 0.5};
  p.max = {far, y + 0.5};
  return probe(w, p);
}
double fastest_corner(const World& w) {
  double most = 0.0;
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (const NodeState& n : testing::nodes(w, t).at) most = std::max(most, norm(n.velocity));
  return most;
}

/// Stress at depth d is -rho g d and K0 times that. Triangles bear the stress at their middles, so
/// that corners that move as one are in equilibrium to rounding; joints bear the stress in their
/// middles, and a corner of its own lacks rho g h^2/24 or so, which a joint bears at a strain of
/// rho g h/(24 * 20 E).
/// @param rounding  of a triangle's force  [-]
void expect_rest(const char* precision, double rounding) {
  SCOPED_TRACE(precision);
  for (const char* joints : {"none", "extrinsic", "intrinsic"}) {
    const bool own_corners = joints[0] == 'i';
    Scene s = ground(joints);
    s.config.precision = precision;
    World w = s.world();
    const double wave = std::sqrt(30e9 / density);
    double most = 0.0;
    while (w.time < 0.02) {  // a wave runs seven times through the depth
      step(w);
      most = std::max(most, fastest_corner(w));
    }
    // A traction that is not balanced moves rock with sigma/(rho c): here all of it would.
    const double thrown = density * gravity * 10.0 / (density * wave);
    EXPECT_LT(most, own_corners ? 2e-2 * thrown : rounding * thrown) << joints;
    for (const double depth : {0.5, 3.5, 8.5}) {
      const double expected = -density * gravity * depth;
      const double error =
          own_corners ? density * gravity / 24.0 : rounding * density * gravity * 10.0;
      EXPECT_NEAR(stress(w, "stress_yy", -depth), expected, error) << joints << depth;
      EXPECT_NEAR(stress(w, "stress_xx", -depth), k0 * expected, error) << joints << depth;
    }
    EXPECT_LT(energies(w).balance.error_relative, 1e-4) << joints;
    EXPECT_TRUE(w.given->warnings.empty()) << w.given->warnings.front();
  }
}
TEST(InSitu, that_grows_with_depth_stays_as_it_is) {
  expect_rest("double", 1e-9);
  expect_rest("single", 16 * 0x1p-24);
}

/// One mean stress everywhere: the ground sinks at once.
TEST(InSitu, without_slope_moves_under_gravity_and_is_told_of) {
  World w = ground("none", false).world();
  testing::run_to(w, 0.005);
  EXPECT_GT(fastest_corner(w), 1e-3);
  ASSERT_EQ(w.given->warnings.size(), 1U);
  EXPECT_NE(w.given->warnings[0].find("not in equilibrium with gravity"), std::string::npos);
  EXPECT_NE(w.given->warnings[0].find("xy_slope[0] + yy_slope[1] are 0, 24525 Pa/m"),
            std::string::npos)
      << w.given->warnings[0];
}

/// A cut of vertical faces under its own weight: an open crack bears the stress at its own depth.
TEST(InSitu, presses_on_the_faces_of_open_cracks) {
  Scene s = ground("none");
  s.config.materials[0].friction = 0.5;
  for (std::size_t e = 0; e < s.model.triangle.size(); ++e) {
    const auto& corners = s.model.triangle[e];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index p = corners[k], q = corners[(k + 1) % 3];
      const Vec2 &a = s.model.point[static_cast<std::size_t>(p)],
                 &b = s.model.point[static_cast<std::size_t>(q)];
      if (std::abs(a.x) < 1e-9 && std::abs(b.x) < 1e-9 && p < q)
        s.model.discontinuities.push_back({{p, q}, -1});
    }
  }
  ASSERT_GE(s.model.discontinuities.size(), 10U);
  World w = s.world();
  testing::run_to(w, 0.02);
  for (const double depth : {1.5, 8.5})
    EXPECT_NEAR(stress(w, "stress_xx", -depth), -k0 * density * gravity * depth,
                0.05 * density * gravity * depth)
        << depth;
}

}  // namespace in_situ_test
}  // namespace breccia::fdem
