#include "core/pair_list.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "unit/core/scenes.hpp"

namespace breccia {
namespace pair_list_test {

using scenes::buffer_of;
using scenes::RandomStream;

/// A history with all kinds of arrays that a state may have.
struct Memory {
  Buffer<double> slid;
  Vec3Planes shear;
  Buffer<std::uint8_t> sticking;

  template <class Visit>
  void each_field(Visit&& field) {
    field("slid", "J", slid);
    field("shear", "N", shear);
    field("sticking", "-", sticking);
  }
};

Pairs pairs_of(const std::set<PairKey>& keys) {
  std::vector<Index> a, b;
  for (const PairKey key : keys) {
    a.push_back(low_id(key));
    b.push_back(high_id(key));
  }
  Pairs pairs;
  copy_to(pairs.key, std::vector<PairKey>(keys.begin(), keys.end()));
  copy_to(pairs.a, a);
  copy_to(pairs.b, b);
  return pairs;
}

std::set<PairKey> random_keys(RandomStream& random, Index elements, Index count) {
  std::set<PairKey> keys;
  for (Index i = 0; i < count; ++i) {
    const Index a = random.below(elements);
    keys.insert(pair_key(a, (a + 1 + random.below(elements - 1)) % elements));
  }
  return keys;
}

struct Remembered {
  double slid;
  double x, y, z;
  std::uint8_t sticking;
  bool operator==(const Remembered&) const = default;
};

Remembered memory_at(const Memory& memory, Index i) {
  const Vec3 shear = memory.shear.view()[i];
  return {memory.slid.data()[i], shear.x, shear.y, shear.z, memory.sticking.data()[i]};
}

void rebuild_at_random(std::uint64_t seed, const Exec& exec, Index elements, Index count) {
  RandomStream random(seed);
  PairList<Memory> list;
  std::map<PairKey, Remembered> book;
  for (int rebuild = 0; rebuild < 10; ++rebuild) {
    std::set<PairKey> keys = random_keys(random, elements, count);
    for (const auto& [key, remembered] : book)
      if (random.below(3) > 0) keys.insert(key);
    std::vector<Index> expected_drops;
    Index place = 0;
    for (const auto& [key, remembered] : book) {
      if (keys.count(key) == 0) expected_drops.push_back(place);
      ++place;
    }

    Pairs found = pairs_of(keys);
    Buffer<Index> dropped;
    find_dropped(exec, list.pairs.key, found.key, dropped);
    std::vector<Index> drops;
    copy_to(drops, dropped);
    ASSERT_EQ(drops, expected_drops) << "seed " << seed;
    list.replace(exec, std::move(found));

    std::erase_if(book, [&](const auto& item) { return keys.count(item.first) == 0; });
    Index i = 0;
    ASSERT_EQ(list.size(), static_cast<Index>(keys.size()));
    for (const PairKey key : keys) {
      ASSERT_EQ(list.pairs.key.data()[i], key);
      const auto known = book.find(key);
      const Remembered expected = known == book.end() ? Remembered{} : known->second;
      ASSERT_EQ(memory_at(list.history, i), expected) << "seed " << seed;
      list.history.slid.view()[i] = random.uniform(-1.0, 1.0);
      list.history.shear.view().store(i, random.inside(1.0));
      list.history.sticking.view()[i] = static_cast<std::uint8_t>(random.below(256));
      book[key] = memory_at(list.history, i);
      ++i;
    }
  }
}

TEST(PairList, CarriesTheHistoryOfSurvivingPairsToTheBitAndStartsNewOnesFromZero) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) rebuild_at_random(seed, {}, 30, 60);
}

TEST(PairList, CarriesHistoryWithAnyNumberOfThreads) {
  for (const int threads : {2, 3, 7}) rebuild_at_random(5, {.threads = threads}, 3000, 4000);
}

TEST(PairList, WorksOnArraysThatOnlyKernelsMayRead) {
  const Exec exec{.space = Space::shadow};
  Memory memory;
  memory.slid = buffer_of(std::vector<double>{1.0, 2.0, 3.0});
  resize_fields(memory, 3);
  move_fields(memory, Space::shadow);
  carry_history(exec, buffer_of(std::vector<PairKey>{1, 5, 9}, Space::shadow), memory,
                buffer_of(std::vector<PairKey>{2, 5, 8, 9}, Space::shadow));
  std::vector<double> slid;
  copy_to(slid, memory.slid);
  EXPECT_EQ(slid, (std::vector<double>{0.0, 2.0, 0.0, 3.0}));
  EXPECT_EQ(memory.slid.space(), Space::shadow);
}

}  // namespace pair_list_test
}  // namespace breccia
