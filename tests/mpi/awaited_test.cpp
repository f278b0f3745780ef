// Elements that other ranks wait for move first, all others while their copies travel.

#include <gtest/gtest.h>

#include "fdem/ranks.hpp"
#include "mpi/on_ranks.hpp"

namespace breccia {
namespace {

using namespace mpi_testing;

/// How often each element is in some of the runs.
std::vector<int> taken(const std::vector<const std::vector<ElementRun>*>& lists, Index count) {
  std::vector<int> times(static_cast<std::size_t>(count), 0);
  for (const auto* runs : lists)
    Domain::each_run_of(*runs, 0, count, [&](Index from, Index to) {
      for (Index e = from; e < to; ++e) ++times[static_cast<std::size_t>(e)];
    });
  return times;
}

TEST(Awaited, each_own_element_moves_once_and_those_with_copies_move_first) {
  std::int64_t first = 0, later = 0;
  simulate_ranks(4, 9, [&](Communicator& ranks) {
    auto whole = box().world();
    auto part = share_out(whole, ranks, {});
    for (int i = 0; i < 40; ++i) step(part);
    const Domain& d = part.domain;
    ASSERT_TRUE(d.knows_felt);
    const Index count = part.triangles.size();
    const auto all = taken({&d.runs}, count), both = taken({&d.awaited_runs, &d.other_runs}, count);
    EXPECT_EQ(all, both);
    const auto awaited = taken({&d.awaited_runs}, count);
    for (const Index e : d.felt.sent().host()) EXPECT_EQ(awaited[static_cast<std::size_t>(e)], 1);
    std::vector<std::int64_t> sums{0, 0};
    for (Index e = 0; e < count; ++e)
      if (d.owns(e)) ++sums[awaited[static_cast<std::size_t>(e)] != 0 ? 0 : 1];
    ranks.add_up(sums);
    if (ranks.rank() == 0) first = sums[0], later = sums[1];
  });
  EXPECT_GT(first, 20);
  EXPECT_GT(later, first);
}

}  // namespace
}  // namespace breccia
