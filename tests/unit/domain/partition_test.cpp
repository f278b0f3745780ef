// Borders between ranks: balance, ownership, and who meets whom.

#include "domain/partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/state_hash.hpp"
#include "domain/simulated_ranks.hpp"

namespace breccia {
namespace partition_test {

/// Numbers in [0, 1) by seed and index.
double unit(std::uint64_t seed, std::uint64_t i) {
  return static_cast<double>(mixed(seed * 0x9e3779b97f4a7c15ULL + i) >> 11) * 0x1p-53;
}

std::vector<Load> cloud(int count, const Vec3& size, std::uint64_t seed) {
  std::vector<Load> loads;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i)
    loads.push_back({{size.x * unit(seed, 4 * i), size.y * unit(seed, 4 * i + 1) * unit(seed, i),
                      size.z * unit(seed, 4 * i + 2)},
                     1 + static_cast<std::int64_t>(5.0 * unit(seed, 4 * i + 3))});
  return loads;
}

Partition cut_alone(int parts, const std::vector<Load>& loads, const Vec3& size, double cell,
                    int depth) {
  Partition partition(parts, {}, size, cell, depth);
  simulate_ranks(1, 1, [&](Communicator& ranks) { partition.cut(ranks, loads); });
  return partition;
}

/// Largest weight of a slice of cells one cell thick.
std::int64_t heaviest_slice(const std::vector<Load>& loads, double cell) {
  std::int64_t heaviest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::map<std::int64_t, std::int64_t> slices;
    for (const Load& l : loads) {
      const double x = axis == 0 ? l.place.x : axis == 1 ? l.place.y : l.place.z;
      auto& slice = slices[static_cast<std::int64_t>(std::floor(x / cell))];
      slice += l.weight;
      heaviest = std::max(heaviest, slice);
    }
  }
  return heaviest;
}

TEST(Partition, every_rank_gets_its_share_up_to_a_slice_at_each_of_its_borders) {
  for (const int depth : {2, 3})
    for (int parts = 1; parts <= 33; ++parts) {
      const Vec3 size{1.0, 0.7, depth == 2 ? 0.0 : 0.5};
      const std::vector<Load> loads = cloud(20000, size, static_cast<std::uint64_t>(parts));
      const double cell = 0.01;
      const Partition partition = cut_alone(parts, loads, size, cell, depth);
      std::vector<std::int64_t> weight(static_cast<std::size_t>(parts), 0);
      std::int64_t total = 0;
      for (const Load& l : loads) {
        weight[static_cast<std::size_t>(partition.owner(l.place))] += l.weight;
        total += l.weight;
      }
      const double share = static_cast<double>(total) / parts;
      const auto slice = static_cast<double>(heaviest_slice(loads, cell));
      for (const std::int64_t w : weight)
        EXPECT_LE(std::abs(static_cast<double>(w) - share), depth * slice)
            << parts << " ranks in " << depth << " dimensions";
    }
}

TEST(Partition, the_owner_of_a_place_is_the_rank_whose_borders_enclose_it) {
  const Vec3 size{2.0, 1.0, 0.5};
  const Partition partition = cut_alone(11, cloud(5000, size, 3), size, 0.02, 3);
  for (const Load& l : cloud(2000, {2.4, 1.2, 0.6}, 4)) {
    const int rank = partition.owner(l.place);
    const double x[3] = {l.place.x, l.place.y, l.place.z};
    for (int axis = 0; axis < 3; ++axis) {
      const auto [low, high] = partition.borders(rank, axis);
      EXPECT_GE(x[axis], low - 1e-12);
      EXPECT_LE(x[axis], high + 1e-12);
    }
  }
}

TEST(Partition, borders_move_by_whole_cells_and_little_when_loads_do) {
  const Vec3 size{1.0, 1.0, 0.0};
  std::vector<Load> loads = cloud(20000, size, 5);
  const Partition before = cut_alone(6, loads, size, 0.01, 2);
  for (Load& l : loads) l.place.x += 0.004;  // less than a cell
  const Partition after = cut_alone(6, loads, size, 0.01, 2);
  for (int rank = 0; rank < 6; ++rank)
    for (int axis = 0; axis < 2; ++axis)
      for (int side = 0; side < 2; ++side) {
        const double from = before.borders(rank, axis)[static_cast<std::size_t>(side)];
        const double to = after.borders(rank, axis)[static_cast<std::size_t>(side)];
        if (std::isinf(from)) continue;
        EXPECT_LE(std::abs(to - from), 0.02 + 1e-12);
        EXPECT_NEAR(to / 0.01, std::round(to / 0.01), 1e-9);
      }
}

TEST(Partition, is_the_same_on_every_rank_however_loads_are_spread) {
  const Vec3 size{1.0, 0.5, 0.3};
  const std::vector<Load> all = cloud(3000, size, 6);
  const Partition expected = cut_alone(7, all, size, 0.02, 3);
  simulate_ranks(7, 9, [&](Communicator& ranks) {
    std::vector<Load> own;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (static_cast<int>(i * i % 7) == ranks.rank()) own.push_back(all[i]);
    Partition partition(7, {}, size, 0.02, 3);
    partition.cut(ranks, own);
    for (int rank = 0; rank < 7; ++rank)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_EQ(partition.borders(rank, axis), expected.borders(rank, axis));
  });
}

TEST(Partition, elements_that_touch_after_both_have_travelled_meet_on_the_owners_rank) {
  const Vec3 size{1.0, 0.6, 0.4};
  constexpr double radius = 0.01, buffer = 0.02;
  for (int parts = 2; parts <= 16; ++parts) {
    const Partition partition = cut_alone(parts, cloud(4000, size, 7), size, 0.013, 3);
    for (std::uint64_t i = 0; i < 3000; ++i) {
      const auto step = [&](std::uint64_t k) { return 2.0 * unit(11, 16 * i + k) - 1.0; };
      const Vec3 e{size.x * unit(8, 3 * i), size.y * unit(8, 3 * i + 1),
                   size.z * unit(8, 3 * i + 2)};
      // Both come up to a buffer's length towards each other, until they touch.
      const double reach = 2.0 * (radius + buffer) * 0.999 / std::sqrt(3.0);
      const Vec3 f = e + reach * Vec3{step(0), step(1), step(2)};
      std::set<int> of_e, of_f;
      partition.each_near(e, 2.0 * (radius + buffer), [&](int r) { of_e.insert(r); });
      partition.each_near(f, 2.0 * (radius + buffer), [&](int r) { of_f.insert(r); });
      EXPECT_TRUE(of_f.contains(partition.owner(e)));
      EXPECT_TRUE(of_e.contains(partition.owner(f)));
      EXPECT_TRUE(of_e.contains(partition.owner(e)));
    }
  }
}

TEST(Partition, more_ranks_than_elements_leaves_some_without_any) {
  const std::vector<Load> loads = cloud(3, {1.0, 1.0, 1.0}, 10);
  const Partition partition = cut_alone(16, loads, {1.0, 1.0, 1.0}, 0.1, 3);
  for (const Load& l : loads) {
    EXPECT_GE(partition.owner(l.place), 0);
    EXPECT_LT(partition.owner(l.place), 16);
  }
}

}  // namespace partition_test
}  // namespace breccia
