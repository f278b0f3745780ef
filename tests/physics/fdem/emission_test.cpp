// A crack of known moment.

#include "fdem/emission.hpp"

#include <gtest/gtest.h>

#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace emission_test {

using testing::far;
using testing::Scene;

/// Two blocks joined along y = 0 by a weak plane that is torn or sheared; rock of E 30 GPa, nu 0.2.
World parted(const Vec2& velocity, const std::vector<std::string>& fix) {
  Scene s;
  s.config.plane = "strain";
  s.material(30e9, 0.2, 2500.0).damping = 0.1;
  s.body("blocks", prepare::crossed_rectangle({{0.0, 0.0}, {0.04, 0.02}}, 0.005));
  JointConfig weak;
  weak.name = "weak";
  weak.strength = {1e6, 2e6, 0.0, 0.0, 10.0, 20.0};
  s.config.joint_laws.push_back(weak);
  std::vector<std::pair<double, Index>> line;
  for (std::size_t i = 0; i < s.model.point.size(); ++i)
    if (std::abs(s.model.point[i].y) < 1e-9 &&
        std::abs(std::remainder(s.model.point[i].x, 0.005)) < 1e-9)
      line.emplace_back(s.model.point[i].x, static_cast<Index>(i));
  std::sort(line.begin(), line.end());
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    s.model.discontinuities.push_back({{line[i].second, line[i + 1].second}, 0});
  s.support("foot", {-far, -far}, {far, -0.00999}, {"x", "y"});
  s.support("head", {-far, 0.00999}, {far, far}, fix, velocity);
  s.config.emission.thickness = 0.1;
  World w = s.world();
  while (w.time < 3e-4) step(w);
  return w;
}
std::vector<EmissionEvent> events(const World& w) {
  std::vector<JointLine> lines;
  for (Index i = 0; i < w.joints.size(); ++i) {
    const Index edge = w.joints.edge_a.data()[i];
    const TriangleNodes& n = testing::nodes(w, edge / 3);
    lines.push_back({n.at[edge % 3].position, n.at[(edge + 1) % 3].position});
  }
  return emission(w, lines);
}

/// Torn at the opening o_t + o_p: M = A o (lambda + 2 mu, lambda) across and along it.
TEST(FdemEmission, of_a_torn_plane_has_the_moment_of_its_opening) {
  const std::vector<EmissionEvent> all = events(parted({0.0, 0.5}, {"x", "y"}));
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].breaks, 8);
  const double o = exact_softening_factor * 10.0 / 1e6, area = 0.04 * 0.1;
  const double lambda = plane_lambda(30e9, 0.2, false), mu = shear_modulus(30e9, 0.2);
  EXPECT_NEAR(all[0].moment.yy, area * o * (lambda + 2.0 * mu), 0.05 * all[0].moment.yy);
  EXPECT_NEAR(all[0].moment.xx, area * o * lambda, 0.05 * all[0].moment.xx);
  EXPECT_NEAR(all[0].moment.zz, all[0].moment.xx, 1e-9 * all[0].moment.xx);
  EXPECT_GT(all[0].isotropic(), 0.3);
  EXPECT_NEAR(all[0].energy, 10.0 * area, 0.05 * 10.0 * area);
}

/// Sheared by s_t, its upper side to the right and to the left: M_xy = A mu s with that sign.
TEST(FdemEmission, of_a_sheared_plane_has_the_moment_of_its_slip) {
  for (const double sense : {1.0, -1.0}) {
    const std::vector<EmissionEvent> all = events(parted({sense * 0.5, 0.0}, {"x", "y"}));
    ASSERT_EQ(all.size(), 1U);
    const double s = exact_softening_factor * 20.0 / 2e6, area = 0.04 * 0.1;
    const double expected = sense * area * s * shear_modulus(30e9, 0.2);
    EXPECT_NEAR(all[0].moment.xy, expected, 0.1 * std::abs(expected)) << sense;
    EXPECT_LT(std::abs(all[0].isotropic()), 0.3);
  }
}

}  // namespace emission_test
}  // namespace breccia::fdem
