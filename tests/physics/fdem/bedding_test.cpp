// Rock that is weaker along planes.

#include <gtest/gtest.h>

#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace bedding_test {

using testing::far;
using testing::Scene;

/// A strip of squares cut by their diagonals, pulled along y.
Scene pulled(double angle, double strength) {
  Scene s;
  MaterialConfig& m = s.material(30e9, 0.0, 2500.0);
  m.joints = "intrinsic";
  m.joint.tension = 5e6;
  m.joint.cohesion = 20e6;
  m.joint.energy_open = 30.0;
  m.bedding = {angle, strength};
  s.body("strip", prepare::crossed_rectangle({{0.0, 0.0}, {0.02, 0.04}}, 0.005));
  s.config.local_damping = 0.5;
  s.support("foot", {-far, -far}, {far, -0.0199}, {"y"});
  s.support("head", {-far, 0.0199}, {far, far}, {"y"}, {0.0, 0.02});
  return s;
}

/// Edges along the planes have `strength`, those across them all, those at 45 degrees the mean.
TEST(Bedding, weakens_joints_by_their_angle) {
  for (const double angle : {0.0, 0.5 * pi}) {
    const World w = pulled(angle, 0.4).world();
    int along = 0, across = 0, between = 0;
    for (Index i = 0; i < w.joints.size(); ++i) {
      const Index edge = w.joints.edge_a.data()[i];
      const Vec2 line = testing::nodes(w, edge / 3).at[(edge + 1) % 3].position -
                        testing::nodes(w, edge / 3).at[edge % 3].position;
      const bool flat = std::abs(line.y) < 1e-9, upright = std::abs(line.x) < 1e-9;
      const bool weak = angle == 0.0 ? flat : upright;
      const double expected = weak ? 0.4 : flat || upright ? 1.0 : 0.7;
      EXPECT_NEAR(w.joints.strength.data()[i], expected, 1e-7);
      (weak ? along : flat || upright ? across : between) += 1;
    }
    EXPECT_GT(along, 0);
    EXPECT_GT(across, 0);
    EXPECT_GT(between, 0);
  }
}

double peak(double angle) {
  Scene s = pulled(angle, 0.4);
  World w = s.world();
  double most = 0.0;
  while (w.time < 8e-4) {
    for (int k = 0; k < 20; ++k) step(w);
    most = std::max(most, -testing::value(w, "head", "force_y", "sum") / 0.02);
  }
  return most;
}

/// Pulled across its planes it bears 0.4 f_t. With planes along the pull edges across it have f_t;
/// those at 45 degrees have 0.7 f_t and fail first, as the rock near them does: at 0.7 f_t over
/// cos^2 45 / cos^2 35 degrees (rock_failure.hpp).
TEST(Bedding, is_felt_across_its_planes) {
  EXPECT_NEAR(peak(0.0), 0.4 * 5e6, 0.01 * 5e6);
  const double at_45 = 0.7 * std::pow(std::cos(35.0 * pi / 180.0), 2) / 0.5;
  EXPECT_NEAR(peak(0.5 * pi), at_45 * 5e6, 0.01 * 5e6);
}

}  // namespace bedding_test
}  // namespace breccia::fdem
