// Equal bits for any number of ranks: triangles that break, fly, push and move as one.

#include <gtest/gtest.h>

#include "fdem/ranks.hpp"
#include "mpi/on_ranks.hpp"

namespace breccia {
namespace fdem_ranks_test {

using namespace mpi_testing;

constexpr int many = 200;  ///< steps of the impact: over a hundred joints are broken then

TEST(FdemRanks, leave_the_same_state_ledger_and_couples_amid_fracture) {
  const Scene scene = impact("intrinsic");
  const Outcome expected = alone(scene, 300);
  EXPECT_GT(expected.cracks, 20U);
  for (const int count : {1, 2, 3, 4, 5, 7, 8, 10, 13, 32})
    EXPECT_EQ(on_ranks(count, scene, 300).outcome, expected) << count << " ranks";
}

TEST(FdemRanks, leave_the_same_state_where_joints_wake_at_their_strength) {
  const Scene scene = impact("extrinsic");
  const Outcome expected = alone(scene, many);
  EXPECT_GT(expected.cracks, 10U);
  for (const int count : {2, 5, 13})
    EXPECT_EQ(on_ranks(count, scene, many).outcome, expected) << count << " ranks";
}

TEST(FdemRanks, leave_the_same_state_of_bedded_rock) {
  Scene scene = impact("intrinsic");
  scene.config.materials[0].bedding = {0.5, 0.6, 15e9, 0.15, 6e9};
  const Outcome expected = alone(scene, many);
  for (const int count : {2, 3, 8})
    EXPECT_EQ(on_ranks(count, scene, many).outcome, expected) << count << " ranks";
}

TEST(FdemRanks, leave_the_same_state_where_all_flies_through_the_borders) {
  const Scene scene = box();
  const Outcome expected = alone(scene, 600);
  EXPECT_GT(expected.energies[1], 0.0);  // blocks press on walls
  DomainConfig config;
  config.buffer = 0.05;  // they are shared out often
  for (const int count : {2, 3, 5, 7, 12, 32}) {
    const Shared shared = on_ranks(count, scene, 600, config);
    EXPECT_EQ(shared.outcome, expected) << count << " ranks";
    EXPECT_GT(shared.counts.migrations, 8);
    EXPECT_GT(shared.counts.cuts, 2);
  }
}

// Nothing but the disc itself, far from where it was shared out, asks for it to be done anew.
TEST(FdemRanks, leave_the_same_state_where_one_strays_far_and_hits) {
  const Scene scene = shot();
  const Outcome expected = alone(scene, 5500);
  EXPECT_LT(expected.energies[0], 0.9 * alone(scene, 100).energies[0]);  // it has hit
  DomainConfig config;
  config.balance = false;
  for (const int count : {3, 5, 7}) {
    const Shared shared = on_ranks(count, scene, 5500, config);
    EXPECT_EQ(shared.outcome, expected) << count << " ranks";
    EXPECT_GT(shared.counts.migrations, 1) << count << " ranks";
  }
}

/// Discs that come near a plate, touch it and part: the step falls and grows with what is near.
TEST(FdemRanks, leave_the_same_state_where_steps_fall_and_grow) {
  Scene scene;
  scene.material(30e9, 0.2, 2500.0).friction = 0.3;
  scene.body("plate", prepare::equilateral_rectangle({{0.0, -0.002}, {0.012, 0.004}}, 1e-3));
  for (int i = 0; i < 2; ++i)
    scene.body(i == 0 ? "first" : "second",
               prepare::ringed_disc({4e-3 * i, 1e-4 + 0.001 + 2e-4 * i}, 0.001, 5e-4), 0,
               {3.0, -40.0});
  const Outcome expected = alone(scene, 1000);
  for (const int count : {2, 3, 5, 8, 16})
    EXPECT_EQ(on_ranks(count, scene, 1000).outcome, expected) << count << " ranks";
}

TEST(FdemRanks, leave_the_same_state_in_mixed_and_single_precision) {
  for (const char* joints : {"intrinsic", "extrinsic"}) {
    Scene scene = impact(joints);
    const std::uint64_t in_double = alone(scene, many).hash;
    for (const char* precision : {"mixed", "single"}) {
      scene.config.precision = precision;
      const Outcome expected = alone(scene, many);
      EXPECT_GT(expected.cracks, 10U);
      EXPECT_NE(expected.hash, in_double);
      for (const auto& [count, threads] : {std::pair{1, 2}, {2, 1}, {3, 2}, {8, 1}, {32, 1}})
        EXPECT_EQ(on_ranks(count, scene, many, {}, threads).outcome, expected)
            << precision << ", " << count << " ranks of " << threads << " threads";
    }
  }
}

TEST(FdemRanks, leave_the_same_state_on_any_number_of_threads_each) {
  for (const char* joints : {"intrinsic", "extrinsic"}) {
    const Scene scene = impact(joints);
    const Outcome expected = alone(scene, many);
    for (const auto& [count, threads] : {std::pair{1, 3}, {2, 2}, {3, 7}, {7, 2}, {32, 3}})
      EXPECT_EQ(on_ranks(count, scene, many, {}, threads).outcome, expected)
          << joints << ", " << count << " ranks of " << threads << " threads";
  }
}

// Stands for ranks that compute on GPUs: their arrays are out of the host's reach.
TEST(FdemRanks, leave_the_same_state_where_arrays_lie_in_another_space) {
  for (const char* joints : {"intrinsic", "extrinsic"}) {
    const Scene scene = impact(joints);
    EXPECT_EQ(on_ranks(3, scene, many, {}, 1, Space::shadow).outcome, alone(scene, many)) << joints;
  }
  const Shared flying = on_ranks(3, box(), 700, {}, 1, Space::shadow);
  EXPECT_EQ(flying.outcome, alone(box(), 700));
  EXPECT_GT(flying.counts.migrations, 4);
}

TEST(FdemRanks, leave_the_same_state_however_borders_and_copies_are_kept) {
  const Scene scene = impact("intrinsic");
  const Outcome expected = alone(scene, many);
  DomainConfig config;
  config.balance = false;
  EXPECT_EQ(on_ranks(4, scene, many, config).outcome, expected);
  config = {};
  config.imbalance = 0.0;
  config.refinement = 10;
  config.buffer = 0.02;
  const Shared eager = on_ranks(5, scene, many, config);
  EXPECT_EQ(eager.outcome, expected);
  EXPECT_GT(eager.counts.cuts, 5);
  config.refinement = 2;
  config.buffer = 2.0;
  EXPECT_EQ(on_ranks(3, scene, many, config).outcome, expected);
}

TEST(FdemRanks, leave_the_same_state_for_any_margin_of_search) {
  Scene scene = impact("intrinsic");
  const std::uint64_t expected = alone(scene, many).hash;
  for (const double margin : {0.02, 0.8}) {
    scene.config.search.margin = margin;
    EXPECT_EQ(on_ranks(4, scene, many).outcome.hash, expected) << margin;
  }
}

TEST(FdemRanks, write_the_same_bytes_and_go_on_from_those_of_any_other_number_of_ranks) {
  const Folder folder("fdem_ranks");
  const std::string state = folder.file("state.br");
  for (const char* joints : {"intrinsic", "extrinsic"}) {
    const Scene scene = impact(joints);
    const Journal expected = journal(1, scene, 110, many, state, "");
    EXPECT_EQ(journal(3, scene, 110, many, state, ""), expected);
    for (const int count : {5, 2, 1})
      EXPECT_EQ(journal(count, scene, 110, many, state, state), expected);
  }
}

}  // namespace fdem_ranks_test
}  // namespace breccia
