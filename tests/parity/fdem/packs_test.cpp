// Numbers beside the hash, for any width of vector: work of joints that soften, slide and stay
// whole beside rock that may fail, and work of local damping, loads and supports.

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "physics/fdem/scene.hpp"

namespace breccia {
namespace fdem_packs_test {

using fdem::testing::Scene;

/// A block of joints that keep friction, damped, pressed or pulled and sheared between two
/// supports; fluid presses on one side.
Scene block(const char* criterion, const char* precision, double pull) {
  using fdem::testing::far;
  Scene s;
  fdem::MaterialConfig& m = s.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.damping = 0.5;
  m.friction = 0.5;
  m.joint.tension = 5e6;
  m.joint.cohesion = 15e6;
  m.joint.energy_open = 20.0;
  m.joint.energy_slide = 200.0;
  m.joint.friction_angle = 0.5;
  m.joint.residual_angle = 0.4;
  s.config.joints.criterion = criterion;
  s.config.precision = precision;
  s.config.local_damping = 0.4;
  s.config.time.end = 1.0;
  s.config.time.evaluate_every = 100;
  s.body("block", prepare::equilateral_rectangle({{0.0, 0.0}, {8e-3, 16e-3}}, 1e-3));
  s.support("top", {-far, 8e-3 - 1e-9}, {far, far}, {"x", "y"}, {0.0, pull});
  s.support("bottom", {-far, -far}, {far, -8e-3 + 1e-9}, {"y"}, {0.0, -pull});
  s.load("side", "pressure", {4e-3 - 1e-9, -far}, {far, far}).pressure = 2e6;
  return s;
}

template <class T>
void expect_same(const Buffer<T>& one, const Buffer<T>& other, const char* what) {
  ASSERT_EQ(one.size(), other.size()) << what;
  for (Index i = 0; i < one.size(); ++i)
    ASSERT_EQ(std::memcmp(&one.data()[i], &other.data()[i], sizeof(T)), 0) << what << " " << i;
}

/// @param pull  speed of both ends, outwards  [m/s]
void expect_same_in_packs(const char* criterion, const char* precision, double pull,
                          fdem::Failure most) {
  SCOPED_TRACE(std::string(precision) + ", " + criterion + ", " + std::to_string(pull));
  const Scene s = block(criterion, precision, pull);
  const auto ended = [&](Lanes lanes) {
    fdem::World w = fdem::make_world(s.config, s.model, in_precision({}, precision));
    w.lanes = lanes;
    while (w.step < 900) fdem::step(w);
    return w;
  };
  const fdem::World one = ended(Lanes::one);
  int softened[3] = {}, slips = 0;
  for (Index i = 0; i < one.joints.size(); ++i) {
    const fdem::JointStage stage = one.joints.stage.data()[i];
    if (stage == fdem::JointStage::softened)
      ++softened[static_cast<int>(fdem::failure_of(one.joints.points.data()[i].point[1]))];
    if (stage == fdem::JointStage::whole && one.joints.work.data()[i].slide != 0.0) ++slips;
  }
  std::printf("%d softened by edges, %d torn, %d sheared; %d whole ones slip\n", softened[0],
              softened[1], softened[2], slips);
  EXPECT_GT(softened[static_cast<int>(most)], 5);
  EXPECT_GT(slips, 5);
  for (const Lanes lanes : {Lanes::four, Lanes::eight}) {
    if (lanes > widest_lanes()) continue;
    const fdem::World w = ended(lanes);
    SCOPED_TRACE(static_cast<int>(lanes));
    expect_same(one.joints.points, w.joints.points, "points");
    expect_same(one.joints.work, w.joints.work, "work");
    expect_same(one.joints.rubbed, w.joints.rubbed, "rubbed");
    expect_same(one.joints.stage, w.joints.stage, "stage");
    expect_same(one.joints.force.in_double, w.joints.force.in_double, "force");
    expect_same(one.joints.force.in_single, w.joints.force.in_single, "force");
    expect_same(one.triangles.nodes, w.triangles.nodes, "nodes");
    expect_same(one.triangles.damping_work, w.triangles.damping_work, "damping");
    expect_same(one.triangles.load_work, w.triangles.load_work, "loads and supports");
    const Energies by_one = fdem::held(one), by_packs = fdem::held(w);
    EXPECT_GT(by_one.elastic.value(), 0.0);
    EXPECT_EQ(std::memcmp(&by_packs, &by_one, sizeof by_one), 0);
  }
}

TEST(FdemPacks, book_and_keep_what_one_by_one_does) {
  for (const char* const precision : {"double", "mixed", "single"}) {
    expect_same_in_packs("rock", precision, -4.0, fdem::Failure::sheared);
    expect_same_in_packs("rock", precision, 1.0, fdem::Failure::torn);
    expect_same_in_packs("edge", precision, -4.0, fdem::Failure::none);
  }
}

}  // namespace fdem_packs_test
}  // namespace breccia
