// The step of elements whose corners move as one, beside 2/omega of the stiffest mode of the whole.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "fdem/shape.hpp"
#include "fdem3/shape.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia::fdem_shared {
namespace bundle_steps_test {

/// omega of the stiffest mode by power iteration: small displacements and what they accelerate.
/// @param small  [m]
template <class World>
double stiffest(World& w, double small) {
  using Shape = ShapeOf<World>;
  auto& e = Shape::elements(w);
  const auto start = e.nodes;
  std::vector<typename Shape::Vector> way(w.vertex.size());
  const Random random{3};
  for (std::size_t n = 0; n < way.size(); ++n)
    for (int axis = 0; axis < Shape::dimension; ++axis)
      part_of(way[n], axis) = random.uniform(static_cast<std::uint64_t>(w.vertex[n]),
                                             static_cast<std::uint32_t>(axis)) -
                              0.5;
  double square = 0.0;
  for (int round = 0; round < 200; ++round) {
    double most = 0.0;
    for (const auto& v : way) most = std::max(most, norm(v));
    for (auto& v : way) v = (small / most) * v;
    for (Index n = 0; n < static_cast<Index>(way.size()); ++n) {
      auto& node = e.nodes.data()[n / Shape::corners].at[n % Shape::corners];
      node = start.data()[n / Shape::corners].at[n % Shape::corners];
      node.position += way[static_cast<std::size_t>(n)];
    }
    evaluate_forces(w);
    double rayleigh = 0.0, size = 0.0;
    for (Index n = 0; n < static_cast<Index>(way.size()); ++n) {
      const double mass = e.mass.data()[n / Shape::corners];
      const auto& force = e.force.data()[n / Shape::corners].at[n % Shape::corners];
      auto& u = way[static_cast<std::size_t>(n)];
      rayleigh -= dot(force, u);
      size += mass * dot(u, u);
      u = (-1.0 / mass) * force;
    }
    square = rayleigh / size;
  }
  e.nodes = start;
  evaluate_forces(w);
  return std::sqrt(square);
}

/// Of elements that move by themselves, as if nothing tied them.
template <class World>
double step_of_elements(const World& w) {
  double least = 1e300;
  const auto stable = stable_step(w);
  for (Index t = 0; t < ShapeOf<World>::elements(w).size(); ++t) least = std::min(least, stable(t));
  return least;
}

template <class World>
void expect_near_limit(World& w, double small) {
  choose_time_step(w);
  const double limit = 2.0 / stiffest(w, small), step = w.least_step;
  std::printf("step %.3f of the limit, of elements by themselves %.3f\n", step / limit,
              step_of_elements(w) / limit);
  EXPECT_LT(step, limit);
  EXPECT_GT(step, 0.5 * limit);
  EXPECT_LT(step_of_elements(w), 0.9 * step);
}

TEST(BundleSteps, of_tetrahedra_are_near_the_limit_of_the_whole) {
  for (const double share : {0.05, 0.2}) {
    fdem3::testing::Scene s;
    s.material(30e9, 0.2, 2500.0);
    s.body("box", fdem3::testing::box({}, {0.06, 0.06, 0.06}, 0.02, share));
    fdem3::World w = s.world();
    expect_near_limit(w, 1e-8);
  }
}
prepare::Mesh uneven_plate() {
  prepare::Mesh mesh = prepare::equilateral_rectangle({{0.0, 0.0}, {0.1, 0.08}}, 0.01);
  const Random random{5};
  for (std::size_t i = 0; i < mesh.point.size(); ++i)
    mesh.point[i] += 0.005 * Vec2{random.uniform(i, 0) - 0.5, random.uniform(i, 1) - 0.5};
  return mesh;
}
TEST(BundleSteps, of_triangles_are_near_the_limit_of_the_whole) {
  fdem::testing::Scene s;
  s.material(30e9, 0.2, 2500.0);
  s.config.plane = "strain";
  s.body("plate", uneven_plate());
  fdem::World w = s.world();
  expect_near_limit(w, 1e-8);
}

/// After joints have changed the elements that may touch are asked; tied ones bear rows together
/// there, too.
template <class World>
void expect_bundles_to_rule_after_breaks(World& w) {
  w.next_dt = 1.0;
  double alone = 1e300;
  const auto stable = stable_step(w);
  for (const Index t : w.reach.element.host()) alone = std::min(alone, stable(t));
  const double step = shortened_time_step(w, w.reach.element);
  EXPECT_EQ(step, choose_time_step(w));
  EXPECT_LT(w.given->time.safety * alone, 0.95 * step);
}
TEST(BundleSteps, rule_when_joints_have_changed) {
  fdem3::testing::Scene solid;
  solid.material(30e9, 0.2, 2500.0);
  solid.body("box", fdem3::testing::box({}, {0.04, 0.04, 0.04}, 0.02, 0.2));
  fdem3::World of_tetrahedra = solid.world();
  expect_bundles_to_rule_after_breaks(of_tetrahedra);
  fdem::testing::Scene plane;
  plane.material(30e9, 0.2, 2500.0);
  plane.body("plate", uneven_plate());
  fdem::World of_triangles = plane.world();
  expect_bundles_to_rule_after_breaks(of_triangles);
}

// A thin row of tetrahedra: its corners carry the mass of the thick ones beside it.
TEST(BundleSteps, of_a_flat_layer_hold_by_the_mass_of_its_neighbours) {
  fdem3::testing::Scene s;
  s.material(30e9, 0.2, 2500.0);
  prepare::TetMesh mesh = prepare::kuhn_box({}, {0.06, 0.06, 0.06}, 0.02);
  for (Vec3& x : mesh.point)
    if (x.z > 0.0) x.z -= 0.017;  // of 20 mm between -10 and 10 are left 3
  s.body("box", mesh);
  fdem3::World w = s.world();
  choose_time_step(w);
  const double limit = 2.0 / stiffest(w, 1e-9);
  EXPECT_LT(w.least_step, limit);
  EXPECT_GT(w.least_step, 0.4 * limit);
}

// Where joints wake, corners part: less mass, and the penalty of the joints.
template <class World, class Scene>
void expect_short_when_joints_wake(const Scene& s) {
  World w = s.world();
  const auto asleep = [&w] {
    return std::count(w.joints.stage.host().begin(), w.joints.stage.host().end(),
                      ShapeOf<World>::Stage::dormant);
  };
  auto before = asleep();
  int woke = 0;
  for (int k = 0; k < 4000 && woke < 3; ++k) {
    step(w);
    const auto now = asleep();
    if (now == before) continue;
    before = now;
    ++woke;
    ASSERT_NE(w.step % w.given->time.evaluate_every, 0);
    const double planned = w.next_dt;
    EXPECT_LE(planned, choose_time_step(w));
  }
  EXPECT_EQ(woke, 3);
}
TEST(BundleSteps, fall_at_once_when_joints_wake) {
  fdem::testing::Scene s;
  fdem::MaterialConfig& m = s.material(30e9, 0.2, 2500.0);
  m.joints = "extrinsic";
  m.joint.tension = 2e6;
  m.joint.cohesion = 8e6;
  m.joint.energy_open = 50.0;
  m.joint.energy_slide = 100.0;
  s.config.time.evaluate_every = 997;
  s.body("bar", prepare::equilateral_rectangle({{0.0, 0.0}, {0.1, 0.02}}, 0.005));
  const double far = fdem::testing::far;
  s.support("left", {-far, -far}, {-0.049, far}, {"x"}, {-2.0, 0.0});
  s.support("right", {0.049, -far}, {far, far}, {"x"}, {2.0, 0.0});
  expect_short_when_joints_wake<fdem::World>(s);
}

}  // namespace bundle_steps_test
}  // namespace breccia::fdem_shared
