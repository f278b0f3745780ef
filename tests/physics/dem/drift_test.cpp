// A scene that flies past as a whole is searched as one at rest.

#include <gtest/gtest.h>

#include <random>

#include "scene.hpp"

namespace breccia::dem {
namespace drift_test {

using testing::Scene;
using testing::state;

/// Loose and linked spheres that fly about, all with a common velocity on top.
Scene swarm(const Vec3& boost) {
  Scene s;
  MaterialConfig& m = s.material("c", "concrete", 30e9, 0.2, 2400.0);
  m.tensile_strength = m.cohesion = 1e15;
  m.rolling_limit = 1e9;
  std::mt19937_64 random(7);
  std::normal_distribution<double> number;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) {
        const double x = number(random), y = number(random), z = number(random);
        s.sphere({0.025 * i, 0.025 * j, 0.025 * k}, 0.01, boost + 8.0 * Vec3{x, y, z});
        if (i % 3 == 1) s.link(s.model.size() - 37, s.model.size() - 1);
      }
  return s;
}

World run(const Scene& s, double margin = 0.0) {
  Scene own = s;
  if (margin > 0.0) own.config.search.margin = margin;
  World w = own.world();
  for (int i = 0; i < 1500; ++i) step(w);
  return w;
}

TEST(Drift, does_not_make_searches_of_a_scene_that_flies_as_a_whole) {
  const World still = run(swarm({}));
  ASSERT_GT(still.searches, 5);
  for (const double speed : {100.0, 1000.0, 20'000.0}) {
    const World flying = run(swarm({speed / 3.0, -2.0 * speed / 3.0, 2.0 * speed / 3.0}));
    EXPECT_NEAR(static_cast<double>(flying.searches), static_cast<double>(still.searches), 1.0)
        << speed;
  }
}

TEST(Drift, searches_change_no_bit_of_a_scene_that_flies) {
  const Scene s = swarm({300.0, -600.0, 600.0});
  const World one = run(s), other = run(s, 0.7);
  ASSERT_NE(one.searches, other.searches);
  EXPECT_EQ(state_hash(one), state_hash(other));
}

TEST(Drift, of_a_body_that_meets_a_wall_is_no_motion_of_the_wall) {
  Scene s = swarm({0.0, 0.0, -60.0});
  s.wall({0.0, 0.0, -0.02}, {0.0, 0.0, 1.0});
  const World w = run(s), other = run(s, 0.7);
  EXPECT_EQ(state_hash(w), state_hash(other));
  for (Index e = 0; e < w.elements.size(); ++e) EXPECT_GT(state(w, e).position.z, -0.0201);
}

/// Numbers that went wrong are found by speed against the others.
TEST(Drift, a_fast_scene_is_sound) {
  const World w = run(swarm({20'000.0, 0.0, 0.0}));
  EXPECT_EQ(find_unsound(w).id, Unsound::none);
}

}  // namespace drift_test
}  // namespace breccia::dem
