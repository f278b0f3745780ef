// Which ranks hold an element: all that may need it, and few others.

#include "domain/sharing_sets.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core/state_hash.hpp"
#include "domain/simulated_ranks.hpp"

namespace breccia {
namespace sharing_sets_test {

constexpr MigrationBuffer migration_buffer{.margin = 0.2, .buffer = 0.25, .per_size = 0.25};
constexpr int ranks_count = 6;

/// In [0, 1), by a thing.
double drawn(std::uint64_t thing) {
  return static_cast<double>(mixed(thing * 0x9e3779b97f4a7c15ULL) >> 11) * 0x1p-53;
}

/// A thousand spheres of about one size, and some that are ten times as large, in a flat room.
std::vector<Sphere> spheres(int large) {
  std::vector<Sphere> all;
  for (std::uint64_t i = 0; i < 1000; ++i)
    all.push_back({{100.0 * drawn(5 * i), 80.0 * drawn(5 * i + 1), 5.0 * drawn(5 * i + 2)},
                   0.4 + 0.1 * drawn(5 * i + 3)});
  for (int l = 0; l < large; ++l)
    all[static_cast<std::size_t>(90 * l + 7)].radius = 4.0 + drawn(static_cast<std::uint64_t>(l));
  return all;
}

/// Who owns and who holds each of them.
struct Held {
  std::vector<int> owner;
  std::vector<std::set<int>> by;
  Index large = 0;
  std::size_t ghosts = 0;        ///< of all elements
  std::size_t by_one_width = 0;  ///< if all reached as far as the largest
};
Held held(const std::vector<Sphere>& all, const SharingSets& sets, const Partition& partition) {
  Held h;
  double largest = 0.0;
  for (const Sphere& s : all) largest = std::max(largest, s.radius);
  for (const Sphere& s : all) {
    h.owner.push_back(partition.owner(s.centre));
    std::set<int> by{h.owner.back()}, wide = by;
    sets.each_sharer(partition, s, sets.buffer(s.radius), [&](int r) { by.insert(r); });
    partition.each_near(
        s.centre, s.radius + largest + 2.0 * migration_buffer.margin + 2.0 * sets.buffer(largest),
        [&](int r) { wide.insert(r); });
    h.ghosts += by.size() - 1;
    h.by_one_width += wide.size() - 1;
    h.by.push_back(std::move(by));
  }
  h.large = sets.large_count();
  return h;
}
Held held_on_ranks(const std::vector<Sphere>& all) {
  Held h;
  simulate_ranks(ranks_count, 3, [&](Communicator& ranks) {
    std::vector<Sphere> own;
    std::vector<Load> loads;
    for (std::size_t e = 0; e < all.size(); ++e)
      if (static_cast<int>(e % ranks_count) == ranks.rank()) {
        own.push_back(all[e]);
        loads.push_back({all[e].centre, 1});
      }
    Partition partition(ranks_count, {}, {100.0, 80.0, 5.0}, 0.2, 2);
    partition.cut(ranks, loads);
    std::vector<int> owners;
    for (const Sphere& s : own) owners.push_back(partition.owner(s.centre));
    SharingSets sets;
    sets.build(ranks, own, owners, migration_buffer);
    if (ranks.rank() == 0) h = held(all, sets, partition);
  });
  return h;
}

TEST(SharingSets, two_that_may_touch_are_held_by_the_owners_of_both) {
  const std::vector<Sphere> all = spheres(10);
  const Held h = held_on_ranks(all);
  int near = 0, large_ones = 0;
  for (std::size_t e = 0; e < all.size(); ++e)
    for (std::size_t f = 0; f < all.size(); ++f) {
      // Each goes as far as it may, towards the other.
      const auto way = [](const Sphere& s) {
        return migration_buffer.margin +
               (s.radius > 1.0 ? 0.5 * s.radius : migration_buffer.buffer);
      };
      const Vec3 d = all[f].centre - all[e].centre;
      const double apart = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
      if (apart > all[e].radius + all[f].radius + way(all[e]) + way(all[f])) continue;
      EXPECT_TRUE(h.by[f].contains(h.owner[e])) << e << " and " << f;
      if (h.owner[e] == h.owner[f]) continue;
      ++near;
      if (all[e].radius > 1.0) ++large_ones;
    }
  EXPECT_GT(near, 50);
  EXPECT_GT(large_ones, 10);
}

TEST(SharingSets, a_few_large_elements_do_not_make_copies_of_all_others) {
  const Held none = held_on_ranks(spheres(0)), some = held_on_ranks(spheres(10));
  EXPECT_EQ(none.large, 0);
  EXPECT_EQ(some.large, 10);
  EXPECT_LT(some.ghosts, 2 * none.ghosts);
  EXPECT_GT(some.by_one_width, 3 * some.ghosts);
}

}  // namespace sharing_sets_test
}  // namespace breccia
