// Joints from the start against joints that appear where strength is reached: bars in tension.

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace extrinsic_test {

using testing::far;
using testing::Scene;

constexpr double young = 30e9, tension = 3e6, width = 8e-3, height = 12e-3, energy = 5.0;

/// A bar pulled slowly at both ends.
Scene bar(const char* joints, const prepare::Mesh& mesh) {
  Scene scene;
  MaterialConfig& m = scene.material(young, 0.2, 2500.0);
  m.joints = joints;
  m.joint.tension = tension;
  m.joint.cohesion = 30e6;
  m.joint.energy_open = energy;
  m.joint.energy_slide = 10.0 * energy;
  m.contact_stiffness = 0.1;  // nothing is pressed: joints or triangles rule the step
  scene.config.time.evaluate_every = 100;
  scene.config.local_damping = 0.3;
  scene.body("bar", mesh);
  const double half = 0.5 * height - 1e-9;
  scene.support("top", {-far, half}, {far, far}, {"y"}, {0.0, 0.008});
  scene.support("bottom", {-far, -far}, {far, -half}, {"y"}, {0.0, -0.008});
  for (SupportConfig& s : scene.config.supports) s.history.ramp = 20e-6;
  return scene;
}
prepare::Mesh rows() {
  return prepare::crossed_rectangle({{0.0, 0.0}, {width, height}}, 1e-3);
}
/// No edge points where another one does.
prepare::Mesh irregular(std::uint64_t seed) {
  prepare::Mesh mesh = prepare::equilateral_rectangle({{0.0, 0.0}, {width, height}}, 1e-3);
  Random random{seed};
  for (std::size_t i = 0; i < mesh.point.size(); ++i) {
    Vec2& x = mesh.point[i];
    const Vec2 by{random.uniform(i, 0) - 0.5, random.uniform(i, 1) - 0.5};
    if (std::abs(x.x) < 0.5 * width - 1e-9 && std::abs(x.y) < 0.5 * height - 1e-9) x += 0.4e-3 * by;
  }
  return mesh;
}
double pull(const World& w) {
  return 0.5 *
         (testing::value(w, "bottom", "force_y", "sum") -
          testing::value(w, "top", "force_y", "sum")) /
         width;
}

struct Pulled {
  double peak = 0.0;      ///< largest stress over f_t  [-]
  double fracture = 0.0;  ///< when it has parted  [J/m2]
  double first_dt = 0.0;  ///< before anything softens  [s]
  double error = 0.0;     ///< of the ledger  [-]
};
/// Until next to nothing holds it together.
Pulled pulled(const char* joints, const char* criterion, const prepare::Mesh& mesh) {
  Scene scene = bar(joints, mesh);
  scene.config.joints.criterion = criterion;
  World w = scene.world();
  Pulled p;
  for (int i = 0; w.time < 2e-3; ++i) {
    step(w);
    if (i == 0) p.first_dt = w.last_dt;
    if (i % 10 != 0) continue;
    const double now = pull(w) / tension;
    p.peak = std::max(p.peak, now);
    if (p.peak > 0.5 && now < 0.05 * p.peak) break;
  }
  const EnergyBalance b = energies(w).balance;
  p.fracture = b.fracture / width;
  p.error = b.error_relative;
  return p;
}

/// Until a joint softens it is the body without joints, bit by bit. Intrinsic joints leave
/// 1/(1 + alpha E/p_f) of its stiffness, alpha = sqrt(3) for equilateral triangles and 1.8 for
/// moved ones, and less where their parabola bends: at the share s of their strength they have
/// opened by 2 (1 - sqrt(1 - s))/s of what their first slope gives.
TEST(Extrinsic, bar_is_as_stiff_as_one_without_joints_and_takes_longer_steps) {
  const auto at_half_strength = [](const char* joints, bool own_step, double& dt) {
    Scene scene = bar(joints, irregular(1));
    if (!own_step) scene.config.time.max_step = 1e-8;
    World w = scene.world();
    step(w);
    dt = w.last_dt;
    testing::run_to(w, 5.75e-5);
    return pull(w);
  };
  double dt = 0.0, dt_intrinsic = 0.0, dt_extrinsic = 0.0;
  const double solid = at_half_strength("none", false, dt);
  const double extrinsic = at_half_strength("extrinsic", false, dt);
  const double intrinsic = at_half_strength("intrinsic", true, dt_intrinsic);
  at_half_strength("extrinsic", true, dt_extrinsic);
  std::printf("stress %.3f f_t; extrinsic %.6f, intrinsic %.4f of the solid's; steps %.3g, %.3g\n",
              solid / tension, extrinsic / solid, intrinsic / solid, dt_extrinsic, dt_intrinsic);
  EXPECT_GT(solid, 0.4 * tension);
  EXPECT_LT(solid, 0.8 * tension);
  EXPECT_EQ(extrinsic, solid);
  const double share = solid / tension, bent = 2.0 * (1.0 - std::sqrt(1.0 - share)) / share;
  EXPECT_LT(intrinsic / solid, 1.0 / (1.0 + std::sqrt(3.0) / 20.0));
  EXPECT_GT(intrinsic / solid, 1.0 / (1.0 + 1.8 / 20.0 * bent));
  EXPECT_GT(dt_extrinsic, 2.0 * dt_intrinsic);
}

/// In uniform tension both kinds have the strength of the material where a row of edges lies
/// across the pull, and nearly that where edges point anywhere: a joint that softens must be free
/// to open by itself, else the bar holds until its neighbours around a vertex are overloaded.
TEST(Extrinsic, bar_parts_at_the_strength_and_energy_of_intrinsic_joints) {
  const auto both = [](const char* what, const char* criterion, const prepare::Mesh& mesh,
                       double above, double apart) {
    const Pulled in = pulled("intrinsic", criterion, mesh);
    const Pulled ex = pulled("extrinsic", criterion, mesh);
    std::printf("%s, %s: peak %.4f and %.4f f_t, energy %.4f and %.4f G, errors %.1e %.1e\n", what,
                criterion, in.peak, ex.peak, in.fracture / energy, ex.fracture / energy, in.error,
                ex.error);
    for (const Pulled& p : {in, ex}) {
      EXPECT_GT(p.peak, 0.99);
      EXPECT_LT(p.peak, above);
      EXPECT_GT(p.fracture, 0.98 * energy);
      EXPECT_LT(p.error, 0.01);
    }
    EXPECT_NEAR(ex.peak, in.peak, 0.01 * in.peak);
    EXPECT_NEAR(ex.fracture, in.fracture, apart * in.fracture);
  };
  both("rows", "edge", rows(), 1.01, 0.1);
  both("rows", "rock", rows(), 1.01, 0.1);
  // the edges nearest to across lie within 15 degrees: 1/cos^2
  both("irregular", "edge", irregular(3), 1.07, 0.1);
  // Not so by the rock. Its bar is a third of E G/f_t^2 wide: how many rows soften before one
  // parts depends on details, and each that stays takes its share.
  both("irregular", "rock", irregular(3), 1.01, 0.5);
}

}  // namespace extrinsic_test
}  // namespace breccia::fdem
