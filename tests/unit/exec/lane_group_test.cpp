// Groups of lanes that work on an item together, as Space::shadow runs them: by whole warps.

#include <gtest/gtest.h>

#include "exec/launch.hpp"

namespace breccia {
namespace lane_group_test {

/// Four lanes an item; each hears of the others' items by their numbers alone.
struct AskGroup {
  static constexpr Index width = 4;
  View<Index> sums, ballots, made;
  Index items;

  BR_HD void operator()(Index i) const {
    const LaneGroup<width> group;
    const bool is_item = i / width < items;
    const Index lane = i % width;
    Index sum = 0;
    for (int k = 0; k < width; ++k) sum += group.from(k, i);
    const unsigned odd = group.ballot(lane % 2 == 1);
    // Item n has n rounds to make: a warp goes on as long as one of its items has any.
    Index rounds = 0;
    for (Index left = is_item ? i / width : 0; group.any_of_warp(left > 0); --left) ++rounds;
    if (!is_item || lane != 0) return;
    sums[i / width] = sum;
    ballots[i / width] = static_cast<Index>(odd);
    made[i / width] = rounds;
  }
};

TEST(LaneGroup, is_apart_from_the_others_of_its_warp) {
  Exec exec;
  exec.space = Space::shadow;
  constexpr Index items = 11;  // of 16 in two warps
  Buffer<Index> sums(Space::host, items), ballots(Space::host, items), rounds(Space::host, items);
  {
    const ShadowLaunches launches;
    for_each_part(exec,
                  part(items * AskGroup::width,
                       AskGroup{sums.view(), ballots.view(), rounds.view(), items}, Parts<>{}));
  }
  for (Index n = 0; n < items; ++n) {
    EXPECT_EQ(sums.data()[n], 16 * n + 6);  // 4 n + (4 n + 1) + (4 n + 2) + (4 n + 3)
    EXPECT_EQ(ballots.data()[n], 0b1010);
    EXPECT_EQ(rounds.data()[n], n < 8 ? 7 : 10);  // the most in its warp of eight items
  }
}

TEST(LaneGroup, is_launched_by_whole_warps) {
  EXPECT_EQ(whole_warps(0), 0);
  EXPECT_EQ(whole_warps(33), 64);
  EXPECT_EQ(threads_for<AskGroup>(44), 64);
}

}  // namespace lane_group_test
}  // namespace breccia
