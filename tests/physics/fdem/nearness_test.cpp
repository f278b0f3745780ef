// Contact counts in the time step only where something is near, and in time.

#include <gtest/gtest.h>

#include "physics/fdem/scene.hpp"
#include "prepare/meshing/structured.hpp"

namespace breccia::fdem {
namespace nearness_test {

using namespace testing;

constexpr double edge = 1e-3;

/// A plate, and a block that flies towards it.
/// @param gap       between both  [m]
/// @param penalty   of contact, over Young's modulus  [-]
Scene two_blocks(double gap, const Vec2& velocity, double penalty = 10.0, int evaluate_every = 1) {
  Scene scene;
  MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
  m.contact_stiffness = penalty;
  m.friction = 0.3;
  scene.config.time.safety = 0.7;
  scene.config.time.evaluate_every = evaluate_every;
  scene.body("plate", prepare::equilateral_rectangle({{0.0, -0.005}, {0.02, 0.01}}, edge));
  scene.body("block", prepare::equilateral_rectangle({{0.0, 0.005 + gap}, {0.01, 0.01}}, edge), 0,
             velocity);
  return scene;
}

double step_of(double gap, double speed, double penalty, int evaluate_every = 1) {
  return two_blocks(gap, {0.0, -speed}, penalty, evaluate_every).world().next_dt;
}

TEST(FdemNearness, contact_costs_no_step_where_nothing_is_near) {
  const double elements = step_of(0.1 * edge, 1.0, 1e-9);
  EXPECT_EQ(step_of(0.1 * edge, 1.0, 10.0), elements);
  EXPECT_LT(step_of(0.01 * edge, 1.0, 10.0), 0.25 * elements);
  EXPECT_LT(step_of(0.0, 0.0, 10.0), 0.25 * elements);
  // From one evaluation to the next it could fly through what is near.
  EXPECT_LT(step_of(0.1 * edge, 1000.0, 10.0), 0.25 * elements);
  EXPECT_EQ(step_of(0.1 * edge, 10.0, 10.0), elements);
  EXPECT_LT(step_of(0.1 * edge, 10.0, 10.0, 100), 0.25 * elements);
}

TEST(FdemNearness, edges_of_one_body_are_not_near_each_other) {
  for (const char* joints : {"none", "intrinsic", "extrinsic"}) {
    const auto stepped = [&](double penalty) {
      Scene scene;
      MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
      m.contact_stiffness = penalty;
      m.joints = joints;
      scene.body("disc", prepare::ringed_disc({0.0, 0.0}, 0.02, 2e-3));
      return scene.world().next_dt;
    };
    EXPECT_EQ(stepped(10.0), stepped(1e-9)) << joints;
    EXPECT_EQ(stepped(1000.0), stepped(1e-9)) << joints;
  }
}

/// The step is short when the first force acts, at any speed and however rarely it is chosen; then
/// it grows again. Contact keeps as much energy as with steps that are short all the time.
TEST(FdemNearness, the_step_is_short_before_faces_meet_and_grows_when_they_part) {
  for (const double speed : {3.0, 30.0, 100.0})
    for (const int evaluate_every : {1, 20}) {
      World w = two_blocks(0.1 * edge, {0.2 * speed, -speed}, 10.0, evaluate_every).world();
      const double near = step_of(0.0, 0.0, 10.0), apart = w.next_dt;
      const auto pressed = [&w] {
        for (Index i = 0; i < w.couples.size(); ++i)
          if (w.couples.history.state.data()[i].work != 0.0) return true;
        return false;
      };
      const double start = energies(w).balance.kinetic;
      const double before = momentum(w).linear.y;
      while (!pressed()) {
        ASSERT_LT(w.time, 1e-3);
        step(w);
      }
      EXPECT_LE(w.last_dt, near) << speed;
      double largest = 0.0;
      const auto stride = [&w, &largest] {
        const double last = w.last_dt;
        step(w);
        largest = std::max(largest, w.last_dt / last);
      };
      while (pressed()) stride();
      for (int i = 0; i < 3000 && w.last_dt < 0.95 * apart; ++i) stride();
      EXPECT_LE(largest, 1.05);
      EXPECT_GE(w.last_dt, 0.95 * apart) << speed;
      const EnergyBalance b = energies(w).balance;
      std::printf("%3g m/s, every %2d: %5d steps of at most %.3g ns, contact %.5f, error %.5f\n",
                  speed, evaluate_every, static_cast<int>(w.step), 1e9 * apart, b.contact / start,
                  b.error_relative);
      EXPECT_LT(std::abs(b.contact), 0.005 * start) << speed;
      EXPECT_LT(b.error_relative, 1.5e-3) << speed;
      EXPECT_NEAR(momentum(w).linear.y, before, 1e-9 * std::abs(before));
    }
}

/// When a joint breaks under pressure its faces are near at once, before a search lists them.
TEST(FdemNearness, faces_of_a_joint_that_breaks_count_at_once) {
  Scene scene;
  MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.contact_stiffness = 100.0;
  scene.body("plate", prepare::equilateral_rectangle({{0.0, 0.0}, {0.02, 0.01}}, edge));
  World w = scene.world();
  const double before = w.next_dt;
  const Index joint = w.joints.size() / 2;
  w.joints.stage.data()[joint] = JointStage::broken;
  EXPECT_LT(choose_time_step(w), 0.5 * before);
  const Index t = w.joints.edge_b.data()[joint] / 3;
  for (NodeState& n : nodes(w, t).at) n.position += Vec2{0.0, 50.0 * edge};
  EXPECT_EQ(choose_time_step(w), before) << "they have parted";
}

}  // namespace nearness_test
}  // namespace breccia::fdem
