// Tetrahedra: the same bits for any thread count, search margin, space, rank count, and across a
// checkpoint.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "domain/simulated_ranks.hpp"
#include "fdem3/ranks.hpp"
#include "physics/fdem3/scene.hpp"
#include "run/method/fdem3_method.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace fdem3_same_bits_test {

using fdem3::testing::meeting_cubes;
using fdem3::testing::Scene;

constexpr int many = 420;

/// Everything that must not depend on who computes it.
struct Outcome {
  std::uint64_t hash = 0;
  std::size_t cracks = 0;
  std::vector<double> energies;
  bool operator==(const Outcome&) const = default;
};
Outcome outcome_of(fdem3::World& w) {
  const EnergyBalance b = fdem3::energies(w).balance;
  return {fdem3::state_hash(w),
          fdem3::cracks(w).size(),
          {b.kinetic, b.elastic, b.fracture, b.friction, b.damping, b.contact, b.work}};
}
Outcome ended(fdem3::World w, int steps = many) {
  while (w.step < steps) fdem3::step(w);
  return outcome_of(w);
}
const Outcome& reference() {
  static const Outcome outcome = ended(meeting_cubes().world());
  return outcome;
}

TEST(Fdem3SameBits, for_any_number_of_threads) {
  EXPECT_GT(reference().cracks, 20U);
  for (const int threads : {2, 7})
    EXPECT_EQ(ended(meeting_cubes().world(threads)), reference()) << threads;
}

/// Pressed joints slip, others soften; and one that is not viscous beside one that is.
TEST(Fdem3SameBits, for_any_width_of_vector) {
  for (const char* joints : {"intrinsic", "none"}) {
    Scene scene = meeting_cubes();
    scene.config.materials[0].joints = joints;
    scene.config.local_damping = joints[0] == 'n' ? 0.1 : 0.0;
    const auto with = [&](Lanes lanes) {
      fdem3::World w = scene.world();
      w.lanes = std::min(lanes, widest_lanes());
      for (Index t = 0; t < w.tetrahedra.size(); t += 3) w.tetrahedra.viscosity.data()[t] = 0.0;
      return ended(std::move(w));
    };
    const Outcome one = with(Lanes::one);
    EXPECT_EQ(with(Lanes::four), one) << joints;
    EXPECT_EQ(with(Lanes::eight), one) << joints;
  }
}

TEST(Fdem3SameBits, for_any_search_margin) {
  for (const double margin : {0.03, 0.3}) {
    Scene scene = meeting_cubes();
    scene.config.search.margin = margin;
    EXPECT_EQ(ended(scene.world()).hash, reference().hash) << margin;
  }
}

TEST(Fdem3SameBits, where_arrays_lie_in_another_space) {
  EXPECT_EQ(ended(meeting_cubes().world(1, Space::shadow)), reference());
}

/// By launches that the device's clock leads, some steps at a time.
Outcome led_by_the_clock(const Scene& scene, int steps = many, int at_once = 37) {
  fdem3::World w = scene.world(1, Space::shadow);
  double least = 1e300, most = 0.0;
  for (std::int64_t next = at_once; w.step < steps; next += at_once)
    while (w.step < std::min<std::int64_t>(next, steps)) {
      const Advanced taken = fdem3::advance(w, {1e300, std::min<std::int64_t>(next, steps)});
      least = std::min(least, taken.dt_min);
      most = std::max(most, taken.dt_max);
    }
  EXPECT_EQ(w.step, steps);
  EXPECT_GT(least, 0.0);
  EXPECT_LE(least, most);
  EXPECT_GT(w.searches, 1);
  return outcome_of(w);
}

TEST(Fdem3SameBits, led_by_the_clock_of_a_device) {
  EXPECT_EQ(led_by_the_clock(meeting_cubes()), reference());
}

/// Supports and loads that follow tables, corners that move as one, borders that absorb, damping.
TEST(Fdem3SameBits, led_by_the_clock_with_tables_over_time) {
  using fdem3::testing::far;
  for (const char* joints : {"none", "intrinsic"}) {
    Scene scene = meeting_cubes();
    scene.config.materials[0].joints = joints;
    scene.config.local_damping = 0.1;
    scene.config.search.margin = 0.03;
    const int steps = 260;
    scene.config.gravity = {0.0, 0.0, -9.81};
    fdem3::SupportConfig& moved =
        scene.support("foot", {-far, -far, -far}, {far, far, -0.0200}, {"x", "z"});
    moved.velocity = OverTime<Vec3>(Vec3{2.0, 0.0, 5.0});
    moved.history.times = {0.0, 2e-5, 5e-5};
    moved.history.factors = {0.0, 1.0, -1.0};
    fdem3::LoadConfig& push = scene.load("push", "pressure", {-far, -far, 0.0199}, {far, far, far});
    push.pressure = 2e6;
    push.history.ramp = 4e-5;
    scene.load("soak", "absorbing", {-far, -far, -far}, {-0.0099, far, far});
    const Outcome expected = ended(scene.world(), steps);
    EXPECT_NE(expected.hash, reference().hash);
    EXPECT_GT(expected.energies[6], 0.0) << joints;
    EXPECT_EQ(led_by_the_clock(scene, steps), expected) << joints;
    EXPECT_EQ(ended(scene.world(1, Space::shadow), steps), expected) << joints;
  }
}

Outcome on_ranks(const Scene& scene, int count, Space space = Space::host, int steps = many) {
  Outcome outcome;
  simulate_ranks(count, static_cast<std::uint64_t>(count), [&](Communicator& ranks) {
    fdem3::World whole = scene.world();
    DomainConfig config;
    config.buffer = 0.1;  // they are shared out often
    fdem3::World part = fdem3::share_out(whole, ranks, config, space);
    for (int i = 0; i < steps; ++i) fdem3::step(part);
    fdem3::collect(part, whole);
    if (ranks.rank() == 0) outcome = outcome_of(whole);
  });
  return outcome;
}

TEST(Fdem3SameBits, for_any_number_of_ranks) {
  const Scene scene = meeting_cubes();
  for (const int count : {1, 2, 3, 8})
    EXPECT_EQ(on_ranks(scene, count), reference()) << count << " ranks";
  EXPECT_EQ(on_ranks(scene, 3, Space::shadow), reference());
}

/// Bodies without joints, whose corners move as one across the borders of ranks, with loads and
/// supports.
TEST(Fdem3SameBits, of_bodies_that_move_as_one_on_ranks) {
  using fdem3::testing::far;
  Scene scene;
  scene.material(30e9, 0.2, 2500.0).damping = 0.05;
  scene.body("bar", fdem3::testing::box({0.0, 0.0, 0.0}, {0.08, 0.02, 0.02}, 0.01));
  scene.support("left", {-far, -far, -far}, {-0.0399, far, far}, {"x", "y", "z"});
  scene.load("push", "pressure", {-far, -far, 0.0099}, {far, far, far}).pressure = 2e5;
  scene.load("soak", "absorbing", {0.0399, -far, -far}, {far, far, far});
  const Outcome expected = ended(scene.world());
  EXPECT_GT(expected.energies[6], 0.0);
  for (const int count : {2, 5}) EXPECT_EQ(on_ranks(scene, count), expected) << count;
}

/// The stiffest corners lie on the cut between two ranks, where each owns half of the tetrahedra.
TEST(Fdem3SameBits, of_the_step_that_corners_on_a_cut_rule) {
  Scene scene;
  scene.material(10e9, 0.2, 2500.0);
  scene.material(90e9, 0.2, 2500.0);
  scene.body("bar", fdem3::testing::box({}, {0.08, 0.02, 0.02}, 0.01, 0.0));
  for (std::size_t t = 0; t < scene.model.tetrahedron.size(); ++t) {
    double middle = 0.0;
    for (const Index corner : scene.model.tetrahedron[t])
      middle += 0.25 * scene.model.point[static_cast<std::size_t>(corner)].x;
    if (std::abs(middle) < 0.01) scene.model.material[t] = 1;
  }
  fdem3::World alone = scene.world();
  const double expected = fdem3::choose_time_step(alone);
  const auto middle_of = [](const fdem3::World& w, Index t) {
    return fdem3::centroid(w.tetrahedra.nodes.data()[t]).x;
  };
  simulate_ranks(2, 2, [&](Communicator& ranks) {
    fdem3::World whole = scene.world();
    fdem3::World part = fdem3::share_out(whole, ranks, DomainConfig{}, Space::host);
    EXPECT_EQ(fdem3::choose_time_step(part), expected);
    int left = 0, right = 0;
    for (Index t = 0; t < part.tetrahedra.size(); ++t)
      if (part.domain.owns(t)) ++(middle_of(part, t) < 0.0 ? left : right);
    EXPECT_TRUE(left == 0 || right == 0) << left << " and " << right;
  });
}

Scene waking_cubes() {
  Scene scene = meeting_cubes();
  scene.config.materials[0].joints = "extrinsic";
  return scene;
}
constexpr int few = 240;  // its steps are longer

/// On three threads.
const Outcome& reference_that_wakes() {
  static const Outcome outcome = [] {
    fdem3::World w = waking_cubes().world(3);
    int in_part = 0;  // steps with joints awake beside others that sleep
    while (w.step < few) {
      fdem3::step(w);
      const auto stage = w.joints.stage.host();
      const auto asleep = std::count(stage.begin(), stage.end(), fdem3::JointStage::dormant);
      in_part += asleep > 0 && asleep < w.joints.size() ? 1 : 0;
    }
    EXPECT_GT(in_part, 10);
    return outcome_of(w);
  }();
  return outcome;
}

TEST(Fdem3SameBits, of_joints_that_wake_at_their_strength) {
  const Scene scene = waking_cubes();
  EXPECT_GT(reference_that_wakes().cracks, 5U);
  EXPECT_EQ(led_by_the_clock(scene, few), reference_that_wakes());
  EXPECT_EQ(on_ranks(scene, 2, Space::host, few), reference_that_wakes());
}

/// @returns the hash at its end
std::uint64_t saved_and_resumed(const Scene& scene, int steps) {
  const ScratchFolder folder;
  const std::unique_ptr<Method> first = make_method(scene.config, scene.model, Exec{});
  while (first->steps() < steps / 2) first->advance({1e300, steps / 2});
  CheckpointWriter writer;
  first->save(writer);
  writer.write(folder / "state.br");
  const std::unique_ptr<Method> second = make_method(scene.config, scene.model, Exec{});
  const CheckpointReader reader(folder / "state.br");
  second->load(&reader);
  while (first->steps() < steps) first->advance({1e300, steps});
  while (second->steps() < steps) second->advance({1e300, steps});
  EXPECT_EQ(second->state_hash(), first->state_hash());
  EXPECT_EQ(second->energy().friction, first->energy().friction);
  return first->state_hash();
}

TEST(Fdem3SameBits, of_a_run_that_is_saved_and_goes_on) {
  EXPECT_EQ(saved_and_resumed(meeting_cubes(), many), reference().hash);
  EXPECT_EQ(saved_and_resumed(waking_cubes(), few), reference_that_wakes().hash);
}

}  // namespace fdem3_same_bits_test
}  // namespace breccia
