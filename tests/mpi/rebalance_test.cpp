// Ranks that take longer get less, between two searches, and the bits stay.

#include <gtest/gtest.h>

#include <algorithm>

#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "fdem/ranks.hpp"
#include "mpi/on_ranks.hpp"
#include "mpi/timed_rank.hpp"

namespace breccia {
namespace rebalance_test {

using namespace mpi_testing;

/// As on_ranks, on ranks of which one after the other is slow; their balance is looked after every
/// few steps.
template <class AScene>
Shared on_uneven_ranks(int count, const AScene& scene, int steps, const DomainConfig& config = {},
                       Space space = Space::host) {
  Shared shared;
  simulate_ranks(count, static_cast<std::uint64_t>(count), [&](Communicator& simulated) {
    TimedRank ranks(simulated);
    auto whole = scene.world(1);
    auto part = share_out(whole, ranks, config, space);
    for (int i = 0; i < steps; ++i) {
      part.domain.pace.resume(ranks);
      step(part);
      ranks.work((i / 30) % count == ranks.rank() ? 30.0 : 10.0);
      part.domain.pace.pause(ranks);
      if (i % 11 == 10) rebalance(part);
    }
    collect(part, whole);
    if (ranks.rank() == 0) shared = {outcome_of(whole), part.domain.counts};
  });
  return shared;
}

TEST(Rebalance, leaves_the_same_state_of_a_slab) {
  const Slab piece = slab_piece();
  const Outcome expected = alone(piece, 300);
  EXPECT_GT(expected.cracks, 50U);
  for (const int count : {2, 3, 8, 16}) {
    const Shared uneven = on_uneven_ranks(count, piece, 300);
    EXPECT_EQ(uneven.outcome, expected) << count << " ranks";
    EXPECT_GT(uneven.counts.cuts, 10) << count << " ranks";
  }
  EXPECT_EQ(on_uneven_ranks(3, piece, 300, {}, Space::shadow).outcome, expected);
}

TEST(Rebalance, leaves_the_same_state_of_joined_triangles) {
  for (const char* joints : {"intrinsic", "extrinsic"}) {
    const Scene scene = impact(joints);
    const Outcome expected = alone(scene, 300);
    for (const int count : {2, 3, 8}) {
      const Shared uneven = on_uneven_ranks(count, scene, 300);
      EXPECT_EQ(uneven.outcome, expected) << joints << ", " << count << " ranks";
      EXPECT_GT(uneven.counts.cuts, 10) << joints << ", " << count << " ranks";
    }
  }
}

TEST(Rebalance, leaves_the_same_state_of_bodies_that_fly) {
  const Outcome expected = alone(box(), 700);
  for (const int count : {3, 8}) {
    const Shared uneven = on_uneven_ranks(count, box(), 700);
    EXPECT_EQ(uneven.outcome, expected) << count << " ranks";
    EXPECT_GT(uneven.counts.moved, 100) << count << " ranks";
  }
}

// Borders fly with the bodies, up to the moment of sharing: a way counted later than that would
// look like one that all have gone since, and at the next search they would be shared out again.
TEST(Rebalance, leaves_nothing_to_share_out_among_bodies_that_only_fly) {
  Scene scene;
  scene.material(30e9, 0.2, 2500.0);
  scene.body("disc", prepare::ringed_disc({0.0, 0.0}, 0.02, 4e-3), 0, {100.0, 30.0});
  simulate_ranks(3, 9, [&](Communicator& simulated) {
    TimedRank ranks(simulated);
    auto whole = scene.world();
    DomainConfig config;
    config.buffer = 0.02;
    auto part = share_out(whole, ranks, config);
    const std::int64_t searches = part.searches;
    part.domain.pace.resume(ranks);
    for (int i = 0; i < 50; ++i) {
      step(part);
      ranks.work(ranks.rank() == 0 ? 30.0 : 10.0);
    }
    part.domain.pace.pause(ranks);
    ASSERT_EQ(part.searches, searches);
    const Vec2 drift = part.reach.drift.velocity;
    ASSERT_GT(norm(part.time * drift), 2.0 * part.domain.buffer);
    rebalance(part);
    EXPECT_EQ(part.domain.counts.cuts, 2);
    EXPECT_EQ(part.domain.counts.migrations, 2);
    find_couples(part);
    EXPECT_EQ(part.domain.counts.migrations, 2);
  });
}

// A stress counts what contacts do: as the last step found it, until the next one.
TEST(Rebalance, leaves_the_stress_of_spheres_as_it_is) {
  const Slab array = spheres_between_walls();
  const auto box = std::find_if(array.config.probes.begin(), array.config.probes.end(),
                                [](const ProbeConfig& p) { return p.quantity == "stress_zz"; });
  for (const Space space : {Space::host, Space::shadow})
    simulate_ranks(3, 3, [&](Communicator& simulated) {
      TimedRank ranks(simulated);
      auto whole = array.world(1);
      auto part = share_out(whole, ranks, {}, space);
      const auto stress = [&] {
        Readings all;
        for (const Readings& own : from_each(ranks, dem::read_own(part, *box))) all = all + own;
        return all.reduced("mean");
      };
      part.domain.pace.resume(ranks);
      for (int i = 0; i < 200; ++i) {
        step(part);
        ranks.work(ranks.rank() == 0 ? 30.0 : 10.0);
      }
      part.domain.pace.pause(ranks);
      const std::int64_t cuts = part.domain.counts.cuts;
      const double before = stress();
      rebalance(part);
      EXPECT_GT(part.domain.counts.cuts, cuts);
      EXPECT_LT(before, 0.0);
      EXPECT_EQ(stress(), before);
    });
}

TEST(Rebalance, counts_what_the_first_sharing_took_where_elements_lie_on_a_device) {
  simulate_ranks(2, 1, [](Communicator& ranks) {
    auto whole = slab_piece().world(1);
    for (const Space space : {Space::host, Space::shadow}) {
      const auto part = share_out(whole, ranks, {}, space);
      EXPECT_EQ(part.domain.pace.spent(ranks).sharing > 0.0, space == Space::shadow);
    }
  });
}

TEST(Rebalance, is_left_out_where_borders_are_to_stay) {
  DomainConfig config;
  config.balance = false;
  const Shared still = on_uneven_ranks(3, slab_piece(), 100, config);
  EXPECT_EQ(still.counts.cuts, 1);
}

}  // namespace rebalance_test
}  // namespace breccia
