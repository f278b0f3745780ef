// How ranks that take longer get less to do.

#include "domain/pace.hpp"

#include <gtest/gtest.h>

#include "core/state_hash.hpp"
#include "domain/partition.hpp"
#include "domain/simulated_ranks.hpp"
#include "mpi/timed_rank.hpp"

namespace breccia {
namespace pace_test {

using mpi_testing::TimedRank;

/// Numbers in [0, 1).
double unit(std::uint64_t i) {
  return static_cast<double>(mixed(i) >> 11) * 0x1p-53;
}

/// Points that cost the same on a plane, cut among ranks of which one is three times as slow as
/// another, and all of whose points beyond x = 0.8 take twice as long as estimated.
void share_by_pace(Communicator& simulated) {
  TimedRank ranks(simulated);
  const int own = ranks.rank();
  const double second_a_point = 1e-5 * (1.0 + 2.0 * (own % 3) / 2.0);
  std::vector<Vec3> points(20'000);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {unit(2 * i), unit(2 * i + 1), 0.0};

  Partition partition(ranks.size(), {}, {1.0, 1.0, 0.0}, 1e-3, 2);
  Pace pace;
  std::vector<int> owner(points.size(), 0);
  double uneven_before = 0.0;
  for (int round = 0; round < 8; ++round) {
    std::vector<Load> loads;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (owner[i] == own) loads.push_back({points[i], pace.weighed(1)});
    partition.cut(ranks, loads);
    pace.begin_again(ranks, 0.01);
    std::int64_t count = 0;
    pace.resume(ranks);
    for (std::size_t i = 0; i < points.size(); ++i) {
      owner[i] = partition.owner(points[i]);
      if (owner[i] != own) continue;
      ++count;
      ranks.work(second_a_point * (points[i].x > 0.8 ? 2.0 : 1.0));
    }
    const Spent spent = pace.spent(ranks);
    if (round == 0) {
      uneven_before = spent.most / spent.mean - 1.0;
      EXPECT_TRUE(spent.is_uneven(0.1));
      EXPECT_FALSE(spent.is_uneven(2.0));
    }
    if (round == 7) {
      EXPECT_GT(uneven_before, 0.3);
      EXPECT_LT(spent.most / spent.mean - 1.0, 0.08);
      EXPECT_FALSE(spent.is_uneven(0.1));
    }
    pace.pause(ranks);
    pace.measure(ranks, count);
  }
}

TEST(Pace, gives_slow_ranks_and_costly_elements_less_until_all_take_the_same_time) {
  for (const int ranks : {2, 3, 7, 16}) simulate_ranks(ranks, 3, share_by_pace);
}

TEST(Pace, counts_nothing_while_it_is_paused) {
  simulate_ranks(2, 1, [](Communicator& simulated) {
    TimedRank ranks(simulated);
    Pace pace;
    ranks.work(1.0);
    pace.resume(ranks);
    ranks.work(ranks.rank() == 0 ? 0.25 : 0.75);
    EXPECT_DOUBLE_EQ(pace.spent(ranks).most, 0.75);
    pace.pause(ranks);
    ranks.work(5.0);
    EXPECT_DOUBLE_EQ(pace.spent(ranks).mean, 0.5);
    EXPECT_DOUBLE_EQ(pace.spent(ranks).most, 0.75);
  });
}

TEST(Pace, weighs_all_alike_where_work_is_not_measured) {
  simulate_ranks(3, 1, [](Communicator& ranks) {
    Pace pace;
    pace.resume(ranks);
    pace.pause(ranks);
    pace.measure(ranks, ranks.rank() + 1);
    EXPECT_EQ(pace.weighed(5), 5 * Pace::unit);
    EXPECT_FALSE(pace.spent(ranks).is_uneven(0.0));
  });
}

TEST(Pace, shares_out_again_only_for_more_than_that_costs) {
  EXPECT_TRUE((Spent{0.1, 0.12, 0.009}).is_uneven(0.1));
  EXPECT_FALSE((Spent{0.1, 0.12, 0.011}).is_uneven(0.1));
  EXPECT_FALSE((Spent{0.1, 0.12, 0.009}).is_uneven(0.3));
  EXPECT_FALSE((Spent{1e-3, 2e-3, 0.0}).is_uneven(0.1));
}

}  // namespace pace_test
}  // namespace breccia
