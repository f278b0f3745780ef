// Prescribed motion: who moves how, and what its work is in the ledger.

#include <gtest/gtest.h>

#include "dem/setup/stages.hpp"
#include "exec/error.hpp"
#include "scene.hpp"

namespace breccia::dem {
namespace support_test {

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
  EXPECT_NEAR(e.work, work, 1e-9 * work);
  EXPECT_GE(least_damping, 0.0);
  EXPECT_GT(e.damping, 0.0);
  EXPECT_LT(e.error_relative, 1e-4);
}

TEST(Support, that_moves_at_once_has_its_elements_move_from_the_start) {
  Scene s;
  s.material("g", "grain", 30e9, 0.2, 2400.0);
  s.sphere({0.0, 0.0, 0.0}, 0.01, {}, {0.0, 0.0, 50.0});
  s.sphere({1.0, 0.0, 0.0}, 0.01, {0.0, 0.0, 3.0});
  s.config.supports = {{"moved", "", {}, {}, {"all"}, {2.0, 0.0, 0.0}, 0.0},
                       {"held", "", {0.9, -1.0, -1.0}, {1.1, 1.0, 1.0}, {"z"}, {}, 0.0}};
  s.config.time.max_step = 1e-5;
  World w = s.world();
  for (int i = 0; i < 10; ++i) step(w);
  const EnergyBalance e = balance(w);
  EXPECT_DOUBLE_EQ(e.kinetic, 0.5 * w.elements.mass.data()[0] * 4.0);
  EXPECT_EQ(e.start, e.kinetic);
  EXPECT_EQ(e.work, 0.0);
}

// A jump of the support's velocity would be booked as m v^2 of work for m v^2 / 2.
TEST(Support, that_moves_at_once_does_the_work_that_its_chain_gets) {
  Scene s = pulled_chain({0.05, 0.0, 0.0});
  for (Vec3& v : s.model.velocity) v = {};
  s.config.time.max_step = 1e-6;  // equal steps: the balance of leapfrog is exact
  World w = s.world();
  for (int i = 0; i < 12; ++i) {  // no link softens
    step(w);
    EXPECT_LT(balance(w).error_relative, 1e-9) << i;
  }
  EXPECT_GT(balance(w).work, 0.0);
}

TEST(Support, that_reaches_its_speed_within_two_steps_does_the_work_of_that_motion) {
  for (const double ramp :
       {4e-6, 12e-6, 35e-6}) {  // after the first, third and some more half steps
    Scene s;
    s.material("g", "grain", 30e9, 0.2, 2400.0);
    s.sphere({0.0, 0.0, 0.0}, 0.01);
    s.config.supports = {{"moved", "", {}, {}, {"all"}, {2.0, 0.0, 0.0}, ramp}};
    s.config.time.max_step = 1e-5;
    World w = s.world();
    for (int i = 0; i < 12; ++i) {
      step(w);
      const EnergyBalance e = balance(w);
      EXPECT_NEAR(e.work, e.kinetic, 1e-12 * e.kinetic) << ramp << ", step " << i;
    }
    EXPECT_DOUBLE_EQ(balance(w).kinetic, 0.5 * w.elements.mass.data()[0] * 4.0);
  }
}

/// Complaint of make_world about a case; empty: nothing.
std::string refusal(const Scene& s) {
  try {
    s.world();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Support, joins_another_one_that_prescribes_other_directions) {
  Scene s = pulled_chain({});
  const Vec3 far{1.0, 1.0, 1.0}, from{0.039, -1.0, -1.0};
  s.config.supports[1] = {"first", "", from, far, {"x", "y"}, {1.0, 0.0, 7.0}, 0.0};
  s.config.supports.push_back({"second", "", from, far, {"z"}, {7.0, 7.0, 2.0}, 1e-4});
  World w = s.world();
  while (w.time < 2e-4) step(w);
  EXPECT_EQ(state(w, 2).velocity.x, 1.0);
  EXPECT_EQ(state(w, 2).velocity.y, 0.0);
  EXPECT_EQ(state(w, 2).velocity.z, 2.0);
  EXPECT_NEAR(state(w, 2).position.x, 0.04 + w.time, 1e-12);
  EXPECT_NEAR(state(w, 2).position.z, 2.0 * (w.time - 0.5e-4), 1e-6);
  // One that says the same of the same direction does no harm.
  s.config.supports.push_back({"third", "", from, far, {"y", "z"}, {0.0, 0.0, 2.0}, 1e-4});
  EXPECT_EQ(refusal(s), "");
}

TEST(Support, that_contradicts_another_one_is_refused_by_name) {
  Scene s = pulled_chain({});
  const Vec3 far{1.0, 1.0, 1.0};
  s.config.supports.push_back(
      {"other", "", {0.019, -1.0, -1.0}, far, {"x", "z"}, {1.0, 0.0, 0.0}, 0.0});
  const std::string said = refusal(s);
  EXPECT_NE(
      said.find("supports moved and other both prescribe x of 1 element (the first is element 2)"),
      std::string::npos)
      << said;
  EXPECT_EQ(said.find("both prescribe z"), std::string::npos) << said;  // both hold it at rest
  s.config.supports[1].velocity = s.config.supports[2].velocity;
  EXPECT_EQ(refusal(s), "");
  s.config.supports[1].ramp = 1e-4;  // the same end, but another way there
  EXPECT_NE(refusal(s), "");
}

/// A piece on a platen whose coefficient of friction is mu, drawn by gravity.
Scene on_platen(double mu, const Vec3& gravity, const Vec3& velocity) {
  Scene s;
  s.material("m", "concrete", 30e9, 0.2, 2400.0);
  for (int k = 0; k < 9; ++k) s.sphere({0.1 * k, 0.0, 0.0}, 0.01, velocity);
  s.config.gravity = gravity;
  s.config.time.max_step = 5e-4;
  SupportConfig platen;
  platen.name = "platen";
  platen.fix = {"z", "spin_x", "spin_y"};
  platen.friction = mu;
  s.config.supports.push_back(platen);
  return s;
}

/// Pressed by g it slides with what is left of a pull beyond mu g, along it, and rests below.
TEST(Platens, rub_with_friction_times_what_they_press) {
  World slides = on_platen(0.25, {3.0, 4.0, -10.0}, {}).world();
  World rests = on_platen(0.501, {3.0, 4.0, -10.0}, {}).world();
  while (slides.time < 0.1) step(slides), step(rests);
  for (const Index e : {0, 8}) {  // one in a pack, and one behind it
    const double t = slides.time - 0.5 * slides.last_dt, pull = 5.0 - 0.25 * 10.0;
    EXPECT_NEAR(state(slides, e).velocity.x, 0.6 * pull * t, 1e-9);
    EXPECT_NEAR(state(slides, e).velocity.y, 0.8 * pull * t, 1e-9);
    EXPECT_EQ(state(slides, e).velocity.z, 0.0);
    EXPECT_EQ(norm(state(rests, e).velocity), 0.0);
  }
  EXPECT_LT(balance(slides).error_relative, 1e-9);
}

/// It comes to rest after v^2 / (2 mu g), and all its energy has gone into the platen.
TEST(Platens, stop_what_slides) {
  World w = on_platen(0.5, {0.0, 0.0, -10.0}, {1.0, 0.0, 0.0}).world();
  const double kinetic = balance(w).kinetic;
  while (w.time < 0.25) step(w);
  EXPECT_NEAR(state(w, 3).position.x, 0.3 + 0.1, 5e-4);
  EXPECT_EQ(norm(state(w, 3).velocity), 0.0);
  EXPECT_NEAR(balance(w).work, -kinetic, 1e-9 * kinetic);
}

/// One platen alone holds what it rubs, along one direction.
TEST(Platens, say_what_they_cannot_share) {
  Scene s = on_platen(0.5, {}, {});
  SupportConfig hold;
  hold.name = "hold";
  hold.fix = {"x"};
  s.config.supports.push_back(hold);
  try {
    s.world();
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("a platen with friction shares element 0 with"),
              std::string::npos)
        << error.what();
  }
  s.config.supports.pop_back();
  s.config.supports[0].fix = {"x", "z"};
  ASSERT_EQ(stage_problems(s.config).size(), 1U);
  EXPECT_NE(stage_problems(s.config)[0].find("a platen with friction fixes one of x, y, z"),
            std::string::npos);
}

}  // namespace support_test
}  // namespace breccia::dem
