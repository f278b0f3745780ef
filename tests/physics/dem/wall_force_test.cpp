// Probes on walls: what presses on them, on one thread, by a device's schedule, and on ranks.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "domain/simulated_ranks.hpp"
#include "physics/dem/scene.hpp"

namespace breccia::dem {
namespace wall_force_test {

using testing::Scene;

ProbeConfig on_wall(const char* wall, const char* quantity) {
  ProbeConfig probe;
  probe.name = probe.on = wall;
  probe.quantity = quantity;
  return probe;
}

/// A column of spheres that stands on a floor, beside a wall that leans on nothing.
Scene column(int height) {
  Scene s;
  s.material("grain", "grain", 1e7, 0.2, 2500.0);
  s.config.gravity = {0.0, 0.0, -9.81};
  s.config.local_damping = 0.3;
  for (int i = 0; i < height; ++i) s.sphere({0.0, 0.0, 0.01 + 0.02 * i}, 0.01, {}, {}, 0);
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  s.config.walls.back().name = "floor";
  s.wall({-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.5, 0.0});
  s.config.walls.back().name = "side";
  return s;
}

TEST(WallForce, of_a_column_at_rest_is_its_weight) {
  Scene s = column(8);
  World w = s.world();
  double weight = 0.0;
  for (const double m : s.model.mass) weight += 9.81 * m;
  for (int i = 0; i < 40'000; ++i) step(w);
  EXPECT_NEAR(probe(w, on_wall("floor", "force_z")), -weight, 1e-6 * weight);
  EXPECT_EQ(probe(w, on_wall("floor", "force_x")), 0.0);
  EXPECT_EQ(probe(w, on_wall("side", "force_x")), 0.0);
  EXPECT_EQ(probe(w, on_wall("side", "velocity_y")), 0.5);
  EXPECT_NEAR(probe(w, on_wall("side", "position_y")), 0.5 * w.time, 1e-12);
}

/// Spheres thrown at the floor: what the floor gives them is what they gain.
TEST(WallForce, gives_spheres_the_momentum_that_they_gain) {
  Scene s;
  s.material("grain", "grain", 1e8, 0.2, 2500.0);
  s.config.contact.friction = 0.4;
  for (int i = 0; i < 6; ++i)
    s.sphere({0.03 * i, 0.001 * i, 0.0105 + 0.001 * i}, 0.01, {1.0, 0.2, -2.0 - 0.1 * i});
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  s.config.walls.back().name = "floor";
  World w = s.world();
  const auto momentum = [&w] {
    Vec3 sum{};
    for (Index e = 0; e < w.elements.size(); ++e)
      sum += w.elements.mass.data()[e] * w.elements.state.data()[e].velocity;
    return sum;
  };
  const Vec3 before = momentum();
  Vec3 impulse{};
  for (int i = 0; i < 3'000; ++i) {
    const double span = 0.5 * (w.last_dt + w.next_dt);
    impulse +=
        span * Vec3{probe(w, on_wall("floor", "force_x")), probe(w, on_wall("floor", "force_y")),
                    probe(w, on_wall("floor", "force_z"))};
    step(w);
  }
  const Vec3 gained = momentum() - before;
  EXPECT_GT(gained.z, 0.0);
  EXPECT_LT(gained.x, 0.0);
  EXPECT_LT(norm(gained + impulse), 1e-12 * norm(impulse));
}

TEST(WallForce, is_the_same_number_by_a_devices_schedule_and_on_ranks) {
  const Scene s = column(5);
  constexpr int steps = 3'000;
  World w = s.world();
  for (int i = 0; i < steps; ++i) step(w);
  const double expected = probe(w, on_wall("floor", "force_z"));
  EXPECT_LT(expected, 0.0);
  Exec exec;
  exec.space = Space::shadow;
  World shadow = make_world(s.config, s.model, exec);
  while (shadow.step < steps) advance(shadow, {1e300, steps});
  EXPECT_EQ(probe(shadow, on_wall("floor", "force_z")), expected);
  simulate_ranks(2, 5, [&](Communicator& ranks) {
    World whole = make_world(s.config, s.model, {});
    World part = share_out(whole, ranks, {}, Space::host);
    for (int i = 0; i < steps; ++i) step(part);
    const Readings own = read_own(part, on_wall("floor", "force_z"));
    const std::vector<Readings> all = from_each(ranks, own);
    if (ranks.rank() != 0) return;
    Readings sum = all[0];
    for (std::size_t r = 1; r < all.size(); ++r) sum = sum + all[r];
    EXPECT_EQ(sum.reduced("mean"), expected);
  });
}

/// Two of three elements reach into the floor, one of them by a tenth of its radius.
TEST(WallForce, of_elements_that_reach_into_a_wall_at_the_start_is_told) {
  const auto told = [](double depth, double floor = 0.0) {
    testing::Scene s;
    s.material("g", "grain", 1e9, 0.2, 2500.0);
    s.sphere({0.0, 0.0, 0.01 - depth}, 0.01);
    s.sphere({0.1, 0.0, 0.01 - 0.5 * depth}, 0.01);
    s.sphere({0.2, 0.0, 0.0101}, 0.01);
    s.wall({0.0, 0.0, floor}, {0.0, 0.0, 1.0});
    s.config.walls.back().name = "floor";
    const World w = s.world();
    double force = 0.0;
    for (const Vec3& push : w.wall_contacts.history.on_wall.host()) force -= push.z;
    EXPECT_EQ(force > 0.0, floor == 0.0);
    return std::pair(w.given->warnings, fmt::format("press with {:.3g} N", force));
  };
  EXPECT_TRUE(told(1e-5).first.empty());
  const auto [warnings, force] = told(1e-3);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(
      warnings[0].starts_with("wall.floor: at the start 2 elements reach into it, by up "
                              "to 1 mm (10 % of a radius), and "))
      << warnings[0];
  EXPECT_NE(warnings[0].find(force), std::string::npos) << warnings[0];
  EXPECT_TRUE(warnings[0].ends_with("with point = [0, 0, -0.001001] it begins without force"))
      << warnings[0];
  EXPECT_TRUE(told(1e-3, -0.001001).first.empty());
}

}  // namespace wall_force_test
}  // namespace breccia::dem
