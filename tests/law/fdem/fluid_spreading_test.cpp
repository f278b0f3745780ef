// Which cracks a fluid has filled at a time.

#include <gtest/gtest.h>

#include <algorithm>

#include "fdem_shared/fluid/spreading.hpp"

namespace breccia::fdem_shared {
namespace fluid_spreading_test {

double share_of(const std::vector<FilledCrack<LineCrack>>& filled, Index edge) {
  for (const FilledCrack<LineCrack>& f : filled)
    if (f.crack.a == edge) return f.share;
  return 0.0;
}

/// Three cracks in a row, of 1, 2 and 1 m; the second breaks at 3 s. The front runs at 2 m/s.
std::vector<LineCrack> row() {
  return {{0, 10, {1, 2}, 1.0, 0.0}, {3, 13, {2, 3}, 2.0, 3.0}, {6, 16, {3, 4}, 1.0, 0.0}};
}

TEST(FluidSpreading, fills_a_row_of_cracks_at_its_speed_and_waits_for_them_to_break) {
  const auto at = [](double now, Index edge) {
    return share_of(filled_cracks(row(), {1}, 2.0, now), edge);
  };
  EXPECT_EQ(at(0.0, 0), 0.0);
  EXPECT_DOUBLE_EQ(at(0.125, 0), 0.25);
  EXPECT_DOUBLE_EQ(at(0.5, 0), 1.0);
  EXPECT_EQ(at(2.9, 3), 0.0);  // the front waits in vertex 2
  EXPECT_DOUBLE_EQ(at(3.5, 3), 0.5);
  EXPECT_EQ(at(3.9, 6), 0.0);
  EXPECT_DOUBLE_EQ(at(4.25, 6), 0.5);
  EXPECT_DOUBLE_EQ(at(100.0, 6), 1.0);
}

TEST(FluidSpreading, fills_what_is_connected_at_once_without_a_speed) {
  EXPECT_EQ(filled_cracks(row(), {1}, 0.0, 2.0).size(), 1U);
  EXPECT_EQ(filled_cracks(row(), {1}, 0.0, 3.0).size(), 3U);
  EXPECT_EQ(filled_cracks(row(), {4}, 0.0, 2.0).size(), 1U);
  EXPECT_TRUE(filled_cracks(row(), {9}, 0.0, 100.0).empty());
}

/// Around a ring of which one way is shorter: the front comes by that one, and then from both
/// sides.
TEST(FluidSpreading, takes_the_shortest_way_whatever_the_order_of_cracks) {
  std::vector<LineCrack> ring{{0, 1, {1, 2}, 1.0, 0.0},
                              {3, 4, {2, 3}, 1.0, 0.0},
                              {6, 7, {1, 4}, 4.0, 0.0},
                              {9, 10, {4, 3}, 2.0, 0.0}};
  for (int turn = 0; turn < 4; ++turn) {
    std::rotate(ring.begin(), ring.begin() + 1, ring.end());
    // At vertex 3 after 2 s, at 4 after 4 s by either way.
    EXPECT_DOUBLE_EQ(share_of(filled_cracks(ring, {1}, 1.0, 3.0), 6), 0.75);
    EXPECT_DOUBLE_EQ(share_of(filled_cracks(ring, {1}, 1.0, 3.0), 9), 0.5);
    EXPECT_DOUBLE_EQ(share_of(filled_cracks(ring, {1}, 1.0, 4.0), 9), 1.0);
  }
}

}  // namespace fluid_spreading_test
}  // namespace breccia::fdem_shared
