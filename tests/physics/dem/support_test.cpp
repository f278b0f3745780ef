// Prescribed motion: who moves how, and what its work is in the ledger.

#include <gtest/gtest.h>

#include "exec/error.hpp"
#include "scene.hpp"

namespace breccia::dem {
namespace {

using testing::Scene;
using testing::state;

/// Three spheres in touch along x, linked; the first is held, the last moves with a velocity that
/// it has from the start.
Scene pulled_chain(const Vec3& velocity) {
  Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0);
  for (const double x : {0.0, 0.02, 0.04})
    s.sphere({x, 0.0, 0.0}, 0.01, x > 0.03 ? velocity : Vec3{});
  s.link(0, 1);
  s.link(1, 2);
  s.config.supports = {
      {"held", "", {-1e-3, -1.0, -1.0}, {1e-3, 1.0, 1.0}, {"all"}, {}, 0.0},
      {"moved", "", {0.039, -1.0, -1.0}, {0.041, 1.0, 1.0}, {"all"}, velocity, 0.0}};
  return s;
}

TEST(Support, does_the_work_of_its_force_where_motion_is_damped) {
  Scene s = pulled_chain({-0.05, 0.02, 0.0});
  s.config.local_damping = 0.3;
  World w = s.world();
  double work = 0.0, least_damping = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 from = state(w, 2).position, before = w.elements.force.data()[2];
    step(w);
    // what the elements do to it, the support takes up; it gains no velocity
    work -= 0.5 * dot(before + w.elements.force.data()[2], state(w, 2).position - from);
    least_damping = std::min(least_damping, balance(w).damping);
  }
  const EnergyBalance e = balance(w);
  EXPECT_GT(work, 0.0);
  // half a step of the last force is booked with the next one
  const double last = 0.5 * norm(w.elements.force.data()[2]) * 0.054 * w.last_dt;
  EXPECT_NEAR(e.work, work, 1.01 * last);
  EXPECT_GE(least_damping, 0.0);
  EXPECT_GT(e.damping, 0.0);
  EXPECT_NEAR(e.missing(), 0.0, 1.01 * last);
}

}  // namespace
}  // namespace breccia::dem
