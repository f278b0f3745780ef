// Steps that follow each other at once, whose forces are summed up in the move of the next one: the
// bits of steps one by one, forces, works and energies of where they end included.

#include "fdem_shared/sum_and_move.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "domain/simulated_ranks.hpp"
#include "fdem/ranks.hpp"
#include "parity/staged_runs.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia {
namespace sum_and_move_test {

constexpr double far = fdem::testing::far;

template <class T>
std::string bytes(const Buffer<T>& array) {
  std::vector<T> items;
  copy_to(items, array);
  return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T)};
}

/// Hash of the state, and of what it does not hold: forces on corners, works, energies.
template <class World>
std::size_t told_of(World& w) {
  const auto& e = fdem_shared::ShapeOf<World>::elements(w);
  const EnergyBalance b = energies(w).balance;
  const double numbers[] = {b.kinetic, b.elastic, b.fracture, b.friction,
                            b.damping, b.contact, b.work};
  return std::hash<std::string>{}(
      std::to_string(state_hash(w)) + bytes(e.force) + bytes(e.viscous_work) +
      bytes(e.damping_work) + bytes(e.load_work) +
      std::string(reinterpret_cast<const char*>(numbers), sizeof numbers));
}
template <class World>
std::size_t one_by_one(World w, std::int64_t steps) {
  while (w.step < steps) step(w);
  return told_of(w);
}
/// @param at_once  the fewest steps that are taken at one go, and the number by which they grow
template <class World>
std::size_t at_once(World w, std::int64_t steps, std::int64_t at_once) {
  std::int64_t next = 0;
  while (w.step < steps) {
    if (w.step >= next) next = std::min(steps, w.step + at_once++);
    advance(w, {1e300, next});
  }
  EXPECT_TRUE(w.summed_apart.known);
  EXPECT_TRUE(w.summed_apart.leaves_most())
      << w.summed_apart.group.size() << " groups of " << w.summed_apart.marked.size();
  EXPECT_GT(w.summed_apart.group.size(), 0);
  return told_of(w);
}

/// A brittle disc that breaks on a plate, with a support, a load that follows a table, damping.
fdem::testing::Scene impact() {
  fdem::testing::Scene s = fdem::testing::brittle_disc(60.0);
  s.config.local_damping = 0.05;
  s.config.gravity = Vec2{0.0, -9.81};
  fdem::LoadConfig& push = s.load("push", "pressure", {-far, -far}, {-0.0299, far}, "plate");
  push.pressure = 3e6;
  push.history.ramp = 4e-5;
  return s;
}

TEST(FdemSumAndMove, gives_the_bits_of_steps_one_by_one_on_threads_and_packs_of_any_width) {
  for (const char* precision : {"double", "mixed", "single"}) {
    fdem::testing::Scene scene = impact();
    scene.config.precision = precision;
    const std::size_t expected = one_by_one(scene.world(1), 250);
    for (const Lanes lanes : {Lanes::one, Lanes::four, Lanes::eight})
      for (const int threads : {1, 3}) {
        fdem::World w = scene.world(threads);
        w.lanes = std::min(lanes, widest_lanes());
        EXPECT_EQ(at_once(std::move(w), 250, 1), expected)
            << precision << ", " << static_cast<int>(lanes);
      }
  }
}
TEST(FdemSumAndMove, gives_them_by_launches_that_a_clock_leads) {
  for (const char* precision : {"double", "mixed", "single"}) {
    fdem::testing::Scene scene = impact();
    scene.config.precision = precision;
    Exec host = in_precision({}, precision), shadow = host;
    shadow.space = Space::shadow;
    const auto world = [&](const Exec& exec) {
      return fdem::make_world(scene.config, scene.model, exec);
    };
    const std::size_t expected = one_by_one(world(host), 250);
    EXPECT_EQ(at_once(world(shadow), 250, 1), expected) << precision;
    EXPECT_EQ(at_once(world(shadow), 250, 90), expected) << precision;
  }
}
TEST(FdemSumAndMove, gives_them_on_ranks) {
  const fdem::testing::Scene scene = impact();
  fdem::World alone = scene.world(1);
  while (alone.step < 250) fdem::step(alone);
  const std::uint64_t expected = fdem::state_hash(alone);
  for (const Space space : {Space::host, Space::shadow})
    simulate_ranks(3, 5, [&](Communicator& ranks) {
      fdem::World whole = scene.world(1);
      DomainConfig config;
      config.buffer = 0.1;  // they are shared out often
      fdem::World part = fdem::share_out(whole, ranks, config, space);
      while (part.step < 250) fdem::advance(part, {1e300, 250});
      fdem::collect(part, whole);
      if (ranks.rank() != 0) return;
      EXPECT_EQ(fdem::state_hash(whole), expected);
    });
}
/// Bodies whose corners move as one, and one whose corners do not.
TEST(FdemSumAndMove, sums_corners_that_move_as_one_apart) {
  fdem::testing::Scene scene = impact();
  scene.material(20e9, 0.2, 2500.0).damping = 0.02;
  scene.body("block", prepare::crossed_rectangle({{0.0, 0.05}, {0.01, 0.01}}, 0.01), 1,
             {0.0, -40.0});
  scene.body("bar", prepare::equilateral_rectangle({{0.1, 0.0}, {0.06, 0.02}}, 4e-3));
  const std::size_t expected = one_by_one(scene.world(1), 250);
  EXPECT_EQ(at_once(scene.world(2), 250, 20), expected);
  Exec shadow;
  shadow.space = Space::shadow;
  EXPECT_EQ(at_once(fdem::make_world(scene.config, scene.model, shadow), 250, 20), expected);
}
TEST(FdemSumAndMove, steps_as_before_where_most_elements_are_summed_apart) {
  fdem::testing::Scene scene;
  scene.material(30e9, 0.2, 2500.0);
  scene.body("bar", prepare::equilateral_rectangle({{0.0, 0.0}, {0.1, 0.02}}, 2e-3), 0, {1.0, 0.0});
  fdem::World w = scene.world(1);
  EXPECT_EQ(fdem::advance(w, {1e300, 40}).steps, 1);
  EXPECT_FALSE(w.summed_apart.leaves_most());
}

/// A strip that is pulled by a support, and held at its other end from a second stage on.
fdem::testing::Scene strip() {
  fdem::testing::Scene s;
  s.material(30e9, 0.2, 2500.0).joints = "intrinsic";
  s.body("strip", prepare::equilateral_rectangle({{0.0, 0.0}, {0.08, 0.02}}, 3e-3));
  s.support("left", {-far, -far}, {-0.0399, far}, {});
  s.support("right", {0.0399, -far}, {far, far}, {"x"});
  s.config.time.end = 1.0;
  s.config.time.evaluate_every = 20;
  fdem::StageConfig pull, swing;
  pull.name = "pull";
  pull.until = 8e-6;
  pull.supports = {{"right", {"same"}, Vec2{3.0, 0.0}, 0.0, {}}};
  swing.name = "swing";
  swing.until = 8e-6;
  swing.supports = {{"left", {"x", "y"}, {}, 0.0, {}}, {"right", {}, {}, 0.0, {}}};
  s.config.stages = {pull, swing};
  return s;
}
std::uint64_t staged(const fdem::testing::Scene& s, std::int64_t at_once, Space space) {
  Exec exec;
  exec.space = space;
  const auto method = make_method(s.config, s.model, exec, nullptr);
  StageControl stages(*method, s.config.probes, "", nullptr);
  while (!stages.finished()) {
    method->advance(stages.limited({1.0, method->steps() + at_once}));
    stages.look();
  }
  EXPECT_GT(method->steps(), 100);
  return method->state_hash();
}
TEST(FdemSumAndMove, follows_supports_that_a_stage_changes) {
  const fdem::testing::Scene s = strip();
  const std::uint64_t expected = staged(s, 1, Space::host);
  EXPECT_EQ(staged(s, 1000, Space::host), expected);
  EXPECT_EQ(staged(s, 1000, Space::shadow), expected);
}

}  // namespace sum_and_move_test
}  // namespace breccia
