// A crack between tetrahedra, of known moment.

#include "fdem3/emission.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fdem_shared/emission.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia::fdem3 {
namespace emission_test {

using testing::far;
using testing::Scene;

constexpr double side = 0.02;

/// Two blocks joined along z = 0 by a weak plane that is torn or sheared; rock of E 30 GPa, nu 0.2.
World parted(const Vec3& velocity) {
  Scene s;
  s.material(30e9, 0.2, 2500.0).damping = 0.1;
  s.body("blocks", prepare::kuhn_box({0.0, 0.0, 0.0}, {side, side, side}, 0.005));
  JointConfig weak;
  weak.name = "weak";
  weak.strength = {1e6, 2e6, 0.0, 0.0, 10.0, 20.0};
  s.config.joint_laws.push_back(weak);
  const auto in_plane = [&](Index v) {
    return std::abs(s.model.point[static_cast<std::size_t>(v)].z) < 1e-9;
  };
  std::vector<std::array<Index, 3>> faces;
  for (const auto& t : s.model.tetrahedron)
    for (int f = 0; f < 4; ++f) {
      std::array<Index, 3> face{};
      for (int k = 0; k < 3; ++k)
        face[static_cast<std::size_t>(k)] = t[static_cast<std::size_t>(corner_of_face(f, k))];
      if (!std::all_of(face.begin(), face.end(), in_plane)) continue;
      std::sort(face.begin(), face.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  for (const auto& face : faces) s.model.discontinuities.push_back({face, 0});
  s.support("foot", {-far, -far, -far}, {far, far, -0.00999}, {"x", "y", "z"});
  s.support("head", {-far, -far, 0.00999}, {far, far, far}, {"x", "y", "z"}, velocity);
  World w = s.world();
  while (w.time < 3e-4) step(w);
  return w;
}
std::vector<EmissionEvent> events(const World& w) {
  return emission(w, [&w](Index face) {
    Vec3 x[3];
    for (int k = 0; k < 3; ++k)
      x[k] = w.tetrahedra.nodes.data()[face / 4].at[corner_of_face(face % 4, k)].position;
    return place_of(x);
  });
}
const double mu = 30e9 / 2.4, lambda = 30e9 * 0.2 / (1.2 * 0.6);

/// Torn at the opening o: M = A o (lambda + 2 mu, lambda, lambda) across and along it.
TEST(Fdem3Emission, of_a_torn_plane_has_the_moment_of_its_opening) {
  const std::vector<EmissionEvent> all = events(parted({0.0, 0.0, 0.5}));
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].breaks, 32);
  const double o = fdem::exact_softening_factor * 10.0 / 1e6, area = side * side;
  EXPECT_NEAR(all[0].moment.zz, area * o * (lambda + 2.0 * mu), 0.05 * all[0].moment.zz);
  EXPECT_NEAR(all[0].moment.xx, area * o * lambda, 0.05 * all[0].moment.xx);
  EXPECT_NEAR(all[0].moment.yy, area * o * lambda, 0.05 * all[0].moment.yy);
  EXPECT_LT(std::abs(all[0].moment.xz), 0.05 * all[0].moment.zz);
  EXPECT_GT(all[0].isotropic(), 0.3);
  EXPECT_NEAR(all[0].energy, 10.0 * area, 0.05 * 10.0 * area);
}

/// Sheared by s, its upper side to one way: M = A mu s (n e + e n) with that sense.
TEST(Fdem3Emission, of_a_sheared_plane_has_the_moment_of_its_slip) {
  const double s = fdem::exact_softening_factor * 20.0 / 2e6, area = side * side;
  const double expected = area * s * mu;
  for (const double sense : {1.0, -1.0}) {
    const std::vector<EmissionEvent> all = events(parted({sense * 0.4, sense * 0.3, 0.0}));
    ASSERT_EQ(all.size(), 1U);
    EXPECT_NEAR(all[0].moment.xz, sense * 0.8 * expected, 0.1 * expected) << sense;
    EXPECT_NEAR(all[0].moment.yz, sense * 0.6 * expected, 0.1 * expected) << sense;
    EXPECT_LT(std::abs(all[0].isotropic()), 0.3);
  }
}

/// A tensor turns with what it tells of: any normal and direction, opened and slid at once.
TEST(Fdem3Emission, has_the_invariants_of_its_moment_in_every_direction) {
  const ElasticTetrahedron law{{lambda, mu}, {}};
  for (const Vec3& n : {Vec3{0.0, 0.0, 1.0}, Vec3{0.48, 0.6, 0.64}}) {
    const Vec3 across = std::abs(n.x) > 0.0 ? Vec3{0.8, 0.0, -0.6} : Vec3{1.0, 0.0, 0.0};
    const Sym3 m = fdem_shared::moment_of(law, n, across, 2.0, 1e-6, 3e-6);
    EXPECT_NEAR(trace(m), 2.0 * 1e-6 * (3.0 * lambda + 2.0 * mu), 1.0);
    EXPECT_NEAR(dot(n, m * n), 2.0 * 1e-6 * (lambda + 2.0 * mu), 1.0);
    EXPECT_NEAR(dot(across, m * n), 2.0 * 3e-6 * mu, 1.0);
  }
}

}  // namespace emission_test
}  // namespace breccia::fdem3
