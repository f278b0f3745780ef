// Cubes with joints that shatter each other: every joule is booked, at several speeds, and what is
// missing is an error of the step, which falls with its square.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/fdem3/scene.hpp"

namespace breccia::fdem3 {
namespace impact_energy_test {

struct Shattered {
  double missing;  ///< over the energy at the start  [-]
  double broken;   ///< share of joints
};
Shattered shatter(const char* criterion, double speed, double damping, double safety) {
  testing::Scene scene = testing::meeting_cubes(criterion);
  for (Vec3& v : scene.model.velocity)
    if (v.z < 0.0) v.z = -speed;
  scene.config.materials[0].damping = damping;
  scene.config.time.safety = safety;
  World w = scene.world();
  const double start = energies(w).balance.kinetic;
  while (w.time < 3e-5) step(w);
  return {std::abs(energies(w).balance.missing()) / start,
          static_cast<double>(cracks(w).size()) / w.joints.size()};
}

// A joint that is pressed while it slips is stronger in shear: pressure that changes takes work on
// a slip that does not. Unbooked, 0.2 % are missing here, whatever the step.
TEST(ImpactEnergy, error_falls_with_the_square_of_the_step) {
  for (const char* criterion : {"edge", "rock"}) {
    const Shattered coarse = shatter(criterion, 60.0, 0.0, 0.6),
                    fine = shatter(criterion, 60.0, 0.0, 0.3);
    EXPECT_GT(coarse.broken, 0.9);
    EXPECT_LT(coarse.missing, 1e-3) << criterion;
    EXPECT_LT(fine.missing, 0.4 * coarse.missing + 1e-6) << criterion;
  }
}

TEST(ImpactEnergy, is_booked_at_all_speeds) {
  double broken = 0.0;
  for (const double speed : {5.0, 20.0, 60.0, 100.0}) {
    const Shattered s = shatter("rock", speed, 0.02, 0.7);
    EXPECT_LT(s.missing, 1e-3) << speed;
    EXPECT_GE(s.broken, broken);
    broken = s.broken;
  }
  EXPECT_GT(broken, 0.9);
}

// Pressure that rises takes work on the slip of joints that are still whole, and gives it back when
// it falls: nothing of it is spent.
TEST(ImpactEnergy, nothing_is_spent_before_a_joint_softens) {
  testing::Scene scene = testing::meeting_cubes();
  for (Vec3& v : scene.model.velocity)
    if (v.z < 0.0) v.z = -8.0;
  World w = scene.world();
  double taken = 0.0, most = 0.0;
  for (; w.time < 6e-5; step(w)) {
    const auto stage = w.joints.stage.host();
    if (std::any_of(stage.begin(), stage.end(), is_damaged)) break;
    double now = 0.0;
    for (const JointWork& work : w.joints.work.host()) now += std::abs(work.open + work.slide);
    taken = std::max(taken, now);
    most = std::max(most, std::abs(energies(w).balance.fracture));
  }
  EXPECT_GT(taken, 1e-7);  // [J]
  EXPECT_EQ(most, 0.0);
}

// Two tetrahedra that swing apart about a line through their common face, too fast for the joint to
// turn them: one side of it softens, and the corner beyond the line presses. What it presses with
// comes back with them.
TEST(ImpactEnergy, a_joint_that_swings_open_and_shut_spends_nothing_on_the_way_back) {
  const double side = 5e-3, speed = 100.0, swing = 1.2e-8;
  testing::Scene scene;
  MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.joint.tension = 3e6;
  m.joint.cohesion = 9e6;
  m.joint.energy_open = 3.0;
  m.joint.energy_slide = 9.0;
  scene.config.joints.criterion = "edge";
  scene.config.time.max_step = 0.01 * swing;
  prepare::TetMesh pair;
  pair.point = {{}, {side, 0.0, 0.0}, {0.0, side, 0.0}, {0.0, 0.0, side}, {0.0, 0.0, -side}};
  pair.tetrahedron = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  scene.body("pair", pair);
  World w = scene.world();
  const auto turn = [&](double share) {
    for (TetrahedronNodes& t : w.tetrahedra.nodes.host()) {
      const double rate = share * (t.at[3].position.z > 0.0 ? speed : -speed) / side;
      for (NodeState& n : t.at)
        n.velocity = rate * Vec3{0.0, n.position.z, 0.85 * side - n.position.y};
    }
  };
  const auto spent_after = [&](double end) {
    while (w.time < end) step(w);
    return energies(w).balance.fracture;
  };
  turn(1.0);
  const double open = spent_after(swing);
  turn(-1.0);
  const double shut = spent_after(2.0 * swing);
  EXPECT_GT(points_of(w.joints, 0).point[0].damage, 0.2);
  EXPECT_TRUE(cracks(w).empty());
  EXPECT_NEAR(shut, open, 1e-3 * open);
}

}  // namespace impact_energy_test
}  // namespace breccia::fdem3
