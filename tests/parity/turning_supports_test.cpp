// Supports that turn what they hold: the same bits on threads, a device's schedule, ranks, and
// resumed in any stage.

#include "parity/staged_runs.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia {
namespace turning_supports_parity {

using namespace breccia::testing;
using fdem::testing::far;

/// Grips go and turn what breaks between them, then turn about another point, then let go.
template <class Scene, class Vector>
void drive(Scene& s, const OverTime<fdem_shared::SpinOf<Vector>>& spin, const Vector& velocity) {
  auto& m = s.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.friction = 0.4;
  m.joint.tension = 1e6;
  m.joint.cohesion = 3e6;
  s.config.time.end = 1.0;
  s.config.time.evaluate_every = 20;
  auto& grip = s.config.supports[1];
  grip.velocity = velocity;
  grip.spin = spin;
  grip.point.x = 0.04;
  s.config.stages.resize(3);
  const char* names[] = {"twist", "back", "free"};
  for (std::size_t k = 0; k < 3; ++k) {
    s.config.stages[k].name = names[k];
    s.config.stages[k].until = 3e-5;
  }
  s.config.stages[1].supports.resize(1);
  auto& back = s.config.stages[1].supports[0];
  back.name = "right";
  back.spin = spin;
  back.velocity = -1.0 * velocity;
  back.ramp = 1e-5;
  s.config.stages[2].supports.resize(1);
  s.config.stages[2].supports[0].name = "right";
  s.config.stages[2].supports[0].fix = {};
}

fdem::testing::Scene strip() {
  fdem::testing::Scene s;
  s.support("left", {-far, -far}, {-0.0399, far}, {"x", "y"});
  s.support("right", {0.0199, -far}, {far, far}, {"x", "y"});
  OverTime<double> spin;
  spin.times = {0.0, 2e-5};
  spin.values = {100.0, 500.0};
  drive<fdem::testing::Scene, Vec2>(s, spin, {0.5, 0.2});
  s.body("strip", prepare::crossed_rectangle({{0.0, 0.0}, {0.08, 0.02}}, 0.01));
  return s;
}
fdem3::testing::Scene bar() {
  fdem3::testing::Scene s;
  s.support("left", {-far, -far, -far}, {-0.0299, far, far}, {"x", "y", "z"});
  s.support("right", {0.0149, -far, -far}, {far, far, far}, {"x", "y", "z"});
  drive<fdem3::testing::Scene, Vec3>(s, Vec3{500.0, 100.0, -50.0}, {0.5, 0.2, 0.1});
  s.body("bar", fdem3::testing::box({}, {0.06, 0.02, 0.02}, 0.01));
  return s;
}

template <class Scene>
double broken(const Scene& s) {
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  EXPECT_LT(method->energy().error_relative, 2e-2);
  return method->probes()[0];
}

TEST(TurningSupports, of_triangles_are_alike_and_resumed) {
  fdem::testing::Scene s = strip();
  s.config.probes = {{"broken", "", "broken", "sum"}};
  EXPECT_GT(broken(s), 3.0);
  expect_alike(s);
  expect_resumed(s);
}
TEST(TurningSupports, of_tetrahedra_are_alike_and_resumed) {
  fdem3::testing::Scene s = bar();
  s.config.probes = {{"broken", "", "broken", "sum"}};
  EXPECT_GT(broken(s), 3.0);
  expect_alike(s);
  expect_resumed(s);
}

}  // namespace turning_supports_parity
}  // namespace breccia
