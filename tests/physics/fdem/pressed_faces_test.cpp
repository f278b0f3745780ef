// Open cracks and touching bodies under stress in situ start in equilibrium.

#include <gtest/gtest.h>

#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace pressed_faces_test {

using namespace testing;

/// Held at its rim; sigma_yy presses on what is level.
void put_in_place(Scene& scene, const char* joints, double shear) {
  for (MaterialConfig& m : scene.config.materials) {
    m.joints = joints;
    m.joint.tension = 10e6;
    m.joint.cohesion = 30e6;
    m.friction = 0.5;
  }
  scene.config.in_situ.xx = -8e6;
  scene.config.in_situ.yy = -5e6;
  scene.config.in_situ.xy = shear;
  scene.support("left", {-far, -far}, {-0.0999, far}, {"x", "y"});
  scene.support("right", {0.0999, -far}, {far, far}, {"x", "y"});
  scene.support("below", {-0.0998, -far}, {0.0998, -0.0999}, {"x", "y"});
  scene.support("above", {-0.0998, 0.0999}, {0.0998, far}, {"x", "y"});
}

/// A plate with an open crack inside.
Scene cracked(const char* joints, double shear) {
  Scene scene;
  scene.material(30e9, 0.2, 2500.0);
  scene.body("plate", prepare::crossed_rectangle({{0.0, 0.0}, {0.2, 0.2}}, 0.02));
  const auto on_crack = [&](Index v) {
    const Vec2& p = scene.model.point[at(v)];
    return std::abs(p.y) < 1e-9 && std::abs(p.x) < 0.0601;
  };
  for (const auto& t : scene.model.triangle)
    for (std::size_t k = 0; k < 3; ++k)
      if (on_crack(t[k]) && on_crack(t[(k + 1) % 3]) && t[k] < t[(k + 1) % 3])
        scene.model.discontinuities.push_back({{t[k], t[(k + 1) % 3]}, -1});
  put_in_place(scene, joints, shear);
  return scene;
}

/// Two blocks whose meshes do not fit each other.
Scene blocks(const char* joints, double shear) {
  Scene scene;
  scene.material(30e9, 0.2, 2500.0);
  scene.material(50e9, 0.25, 2500.0);
  scene.body("lower", prepare::crossed_rectangle({{0.0, -0.05}, {0.2, 0.1}}, 0.02));
  scene.body("upper", prepare::crossed_rectangle({{0.0, 0.05}, {0.2, 0.1}}, 0.025), 1);
  put_in_place(scene, joints, shear);
  return scene;
}

double fastest_after(World& w, int steps) {
  for (int i = 0; i < steps; ++i) step(w);
  double fastest = 0.0;
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (const NodeState& n : nodes(w, t).at) fastest = std::max(fastest, norm(n.velocity));
  return fastest;
}

/// A stress of 5 MPa that is not balanced would move it with 0.6 m/s.
TEST(FdemPressedFaces, bear_stress_in_situ_from_the_start) {
  for (const char* joints : {"none", "intrinsic", "extrinsic"})
    for (const double shear : {0.0, 2e6, -2e6})
      for (const bool apart : {false, true}) {
        World w = (apart ? blocks(joints, shear) : cracked(joints, shear)).world();
        const double start = energies(w).balance.elastic;
        const double fastest = fastest_after(w, 400);
        const EnergyBalance b = energies(w).balance;
        std::printf("%s, %s, shear %g: %.2e m/s, kinetic %.1e, friction %.1e of %.1f J/m\n",
                    apart ? "blocks" : "crack", joints, shear, fastest, b.kinetic, b.friction,
                    start);
        EXPECT_LT(fastest, 1e-3);
        EXPECT_LT(b.kinetic, 1e-6 * start);
        EXPECT_LT(b.friction, 1e-6 * start);
        EXPECT_LT(b.error_relative, 1e-6);
        for (const Sym2& s : stresses(w)) EXPECT_NEAR(s.yy, -5e6, 0.02e6);
        for (const std::string& said : w.given->warnings)
          EXPECT_EQ(said.find("in situ"), std::string::npos) << said;
      }
}

TEST(FdemPressedFaces, have_the_same_bits_in_the_shadow_space) {
  const Scene scene = blocks("intrinsic", 2e6);
  Exec shadow;
  shadow.space = Space::shadow;
  World there = make_world(scene.config, scene.model, shadow), here = scene.world();
  while (there.step < 40) advance(there, {1e300, 40});
  fastest_after(here, 40);
  EXPECT_EQ(state_hash(there), state_hash(here));
}

TEST(FdemPressedFaces, say_which_faces_cannot_bear_it) {
  World w = cracked("intrinsic", 4e6).world();  // friction holds 2.5 MPa
  ASSERT_FALSE(w.given->warnings.empty());
  EXPECT_NE(w.given->warnings[0].find("6 pairs of faces"), std::string::npos)
      << w.given->warnings[0];
  EXPECT_GT(fastest_after(w, 100), 0.01);
}

}  // namespace pressed_faces_test
}  // namespace breccia::fdem
