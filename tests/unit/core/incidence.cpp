#include "core/incidence.hpp"

#include <gtest/gtest.h>

#include "unit/core/scenes.hpp"

namespace breccia {
namespace incidence_test {

using scenes::buffer_of;
using scenes::RandomStream;

struct Ends {
  std::vector<Index> a, b;
  std::vector<GlobalId> ids;
};

Ends random_ends(RandomStream& random, Index elements, Index pairs) {
  Ends ends;
  scenes::Scene scene;
  for (Index i = 0; i < elements; ++i) scene.add({}, 0.0);
  shuffle_ids(scene, random);
  ends.ids = scene.ids;
  for (Index p = 0; p < pairs; ++p) {
    const Index a = random.below(elements);
    const Index b = (a + 1 + random.below(elements - 1)) % elements;
    ends.a.push_back(a);
    ends.b.push_back(b);
  }
  return ends;
}

std::vector<std::vector<Entry>> rows_by_hand(const Ends& ends) {
  std::vector<std::vector<Entry>> rows(ends.ids.size());
  for (std::size_t p = 0; p < ends.a.size(); ++p) {
    rows[static_cast<std::size_t>(ends.a[p])].push_back(static_cast<Entry>(2 * p));
    rows[static_cast<std::size_t>(ends.b[p])].push_back(static_cast<Entry>(2 * p + 1));
  }
  const auto partner = [&](Entry entry) {
    const auto pair = static_cast<std::size_t>(pair_of(entry));
    return ends.ids[static_cast<std::size_t>(side_of(entry) == 0 ? ends.b[pair] : ends.a[pair])];
  };
  for (auto& row : rows)
    std::stable_sort(row.begin(), row.end(),
                     [&](Entry one, Entry other) { return partner(one) < partner(other); });
  return rows;
}

std::vector<std::vector<Entry>> rows_built(const Ends& ends, const Exec& exec) {
  Incidence incidence(exec.space);
  build_incidence(exec, buffer_of(ends.a, exec.space), buffer_of(ends.b, exec.space),
                  buffer_of(ends.ids, exec.space), incidence);
  std::vector<Index> starts;
  std::vector<Entry> entries;
  copy_to(starts, incidence.starts);
  copy_to(entries, incidence.entries);
  std::vector<std::vector<Entry>> rows;
  for (std::size_t e = 0; e < ends.ids.size(); ++e)
    rows.emplace_back(entries.begin() + starts[e], entries.begin() + starts[e + 1]);
  return rows;
}

TEST(Incidence, ListsThePairsOfEachElementByTheIdOfThePartner) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    RandomStream random(seed);
    const Ends ends = random_ends(random, 2 + random.below(40), random.below(200));
    ASSERT_EQ(rows_built(ends, {}), rows_by_hand(ends)) << "seed " << seed;
  }
}

TEST(Incidence, SortsTheLongRowOfAnElementThatTouchesAllOthers) {
  RandomStream random(1);
  Ends ends = random_ends(random, 3000, 0);
  for (Index other = 1; other < 3000; ++other) {
    ends.a.push_back(other % 2 == 0 ? 0 : other);
    ends.b.push_back(other % 2 == 0 ? other : 0);
  }
  EXPECT_EQ(rows_built(ends, {}), rows_by_hand(ends));
}

TEST(Incidence, GivesTheSameRowsFor123And7ThreadsAndInKernelsOnly) {
  RandomStream random(2);
  const Ends ends = random_ends(random, 5000, 40'000);
  const auto alone = rows_built(ends, {});
  for (const int threads : {2, 3, 7})
    EXPECT_EQ(rows_built(ends, {.threads = threads}), alone) << threads << " threads";
  EXPECT_EQ(rows_built(ends, {.space = Space::shadow}), alone);
}

TEST(Incidence, HasEmptyRowsWithoutPairs) {
  const Ends ends{{}, {}, {4, 2, 9}};
  EXPECT_EQ(rows_built(ends, {}), (std::vector<std::vector<Entry>>(3)));
}

}  // namespace incidence_test
}  // namespace breccia
