#include "core/broad_phase.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include "exec/error.hpp"
#include "unit/core/scenes.hpp"

namespace breccia {
namespace broad_phase_test {

using scenes::all_against_all;
using scenes::RandomStream;
using scenes::Scene;
using scenes::search;

Scene cloud(RandomStream& random, Index count, double half_width, double smallest, double largest) {
  Scene scene;
  for (Index i = 0; i < count; ++i)
    scene.add(random.inside(half_width),
              {random.uniform(smallest, largest), random.uniform(smallest, largest),
               random.uniform(smallest, largest)});
  return scene;
}

/// Sizes over two decades, as many in each octave.
Scene wide_range(RandomStream& random, Index count, double half_width) {
  Scene scene;
  for (Index i = 0; i < count; ++i) {
    double half = random.uniform(0.005, 0.01);
    for (Index octave = random.below(7); octave > 0; --octave) half *= 2.0;
    scene.add(random.inside(half_width), half);
  }
  return scene;
}

/// Boxes that touch at their borders only, where cells may begin.
Scene lattice(Index across, double width) {
  Scene scene;
  for (Index z = 0; z < across; ++z)
    for (Index y = 0; y < across; ++y)
      for (Index x = 0; x < across; ++x)
        scene.add({width * (x - across / 2), width * (y - across / 2), width * (z - across / 2)},
                  0.5 * width);
  return scene;
}

TEST(BroadPhase, FindsWhatComparingAllFindsIn2000RandomClouds) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    RandomStream random(seed);
    const Index count = random.below(80);
    const double half_width = seed % 3 == 0 ? 0.5 : 5.0;
    Scene scene = cloud(random, count, half_width, seed % 2 == 0 ? 0.0 : 0.4, 0.5);
    if (seed % 5 != 0) shuffle_ids(scene, random);
    ASSERT_EQ(search(scene), all_against_all(scene)) << "seed " << seed;
  }
}

TEST(BroadPhase, FindsWhatComparingAllFindsInClusters) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    RandomStream random(seed);
    Scene scene;
    for (Index cluster = 0; cluster < 5; ++cluster) {
      const Vec3 centre = random.inside(50.0);
      for (Index i = 0; i < 40; ++i)
        scene.add(centre + random.inside(1.0), random.uniform(0.1, 0.3));
    }
    shuffle_ids(scene, random);
    ASSERT_EQ(search(scene), all_against_all(scene)) << "seed " << seed;
  }
}

TEST(BroadPhase, FindsAllPairsOfElementsInOneCell) {
  RandomStream random(1);
  Scene scene = cloud(random, 150, 0.01, 0.5, 0.5);
  shuffle_ids(scene, random);
  EXPECT_EQ(search(scene), all_against_all(scene));
  EXPECT_EQ(search(scene).size(), 150u * 149u / 2u);
}

TEST(BroadPhase, TakesNoNoticeOfADistanceOf1e9) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomStream random(seed);
    Scene scene = cloud(random, 60, 2.0, 0.2, 0.5);
    for (Index i = 0; i < 10; ++i) {
      const Vec3 away = random.inside(1e9);
      scene.add(away, 0.5);
      scene.add(away + random.inside(1.0), 0.5);
    }
    scene.add({1e300, -1e300, 1e300}, 0.5);
    scene.add({1e300, -1e300, 1e300}, 0.5);
    shuffle_ids(scene, random);
    ASSERT_EQ(search(scene), all_against_all(scene)) << "seed " << seed;
  }
  RandomStream random(7);
  Scene scene = cloud(random, 4000, 8.0, 0.5, 0.5);
  std::int64_t together = 0, apart = 0;
  search(scene, {}, &together);
  scene.add({1e9, 1e9, 1e9}, 0.5);
  search(scene, {}, &apart);
  EXPECT_LE(apart, together + 100);
}

TEST(BroadPhase, FindsPairsAcrossTheSeamsOfTheCellNumbers) {
  const double cell = 1.0 + 1.0 / 256.0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomStream random(seed);
    Scene scene;
    const double columns = 1048576.0, rows = 524288.0;  // 2^20, 2^19: where numbers start again
    for (const double x : {-columns, 0.0, columns})
      for (const double y : {-rows, 0.0, rows})
        for (const double z : {0.0, rows})
          for (Index i = 0; i < 6; ++i)
            scene.add(Vec3{cell * x, cell * y, cell * z} + random.inside(1.0),
                      i == 0 ? 0.5 : random.uniform(0.1, 0.5));
    shuffle_ids(scene, random);
    ASSERT_EQ(search(scene), all_against_all(scene)) << "seed " << seed;
  }
}

TEST(BroadPhase, FindsBoxesThatShareOnlyABorderOnALattice) {
  for (const double width : {1.0, 0.1, 0.3, 1.0 / 3.0, 256.0 / 257.0}) {
    const Scene scene = lattice(9, width);
    EXPECT_EQ(search(scene), all_against_all(scene)) << "width " << width;
  }
  EXPECT_EQ(search(lattice(9, 1.0)).size(), 7448u);  // ((3 x 9 - 2)^3 - 9^3) / 2
}

TEST(BroadPhase, FindsWhatComparingAllFindsWithSizesFrom1To100) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    RandomStream random(seed);
    Scene scene = wide_range(random, 200, 1.5);
    shuffle_ids(scene, random);
    ASSERT_EQ(search(scene), all_against_all(scene)) << "seed " << seed;
  }
}

TEST(BroadPhase, ComparesFewBoxesAlthoughOneElementIs100TimesLarger) {
  RandomStream random(3);
  Scene scene = cloud(random, 20'000, 5.0, 0.1, 0.1);
  std::int64_t without = 0, with = 0;
  search(scene, {}, &without);
  scene.add({4.0, 4.0, 4.0}, 10.0);
  const auto pairs = search(scene, {}, &with);
  EXPECT_LE(with, without + 20'000);
  EXPECT_LT(with, 20 * 20'000);
  EXPECT_EQ(pairs, all_against_all(scene));
}

TEST(BroadPhase, ComparesFewBoxesWhenSizesSpreadOverTwoDecades) {
  RandomStream random(4);
  const Scene scene = wide_range(random, 20'000, 10.0);
  std::int64_t tested = 0;
  const auto pairs = search(scene, {}, &tested);
  EXPECT_LT(tested, 20 * static_cast<std::int64_t>(pairs.size() + scene.boxes.size()));
}

TEST(BroadPhase, SearchesBoxesOfOnePlaneInTwoDimensions) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    RandomStream random(seed);
    Scene scene;
    for (Index i = 0; i < 120; ++i) {
      const double half = random.uniform(0.05, 0.5);
      scene.add({random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0), 0.0}, {half, half, 0.25});
    }
    shuffle_ids(scene, random);
    ASSERT_EQ(search(scene), all_against_all(scene)) << "seed " << seed;
  }
  // Squares as wide as a cell, one in each on average: half of 5 to 9 neighbour cells, as against
  // three layers of them.
  RandomStream random(5);
  Scene flat;
  for (Index i = 0; i < 10'000; ++i)
    flat.add({random.uniform(0.0, 100.0), random.uniform(0.0, 100.0), 3.0}, {0.5, 0.5, 50.0});
  std::int64_t tested = 0;
  search(flat, {}, &tested);
  EXPECT_LT(tested, 5 * 10'000);
}

TEST(BroadPhase, GivesTheSameListFor123And7Threads) {
  RandomStream random(6);
  Scene scene = cloud(random, 20'000, 9.0, 0.1, 0.5);
  scene.add({0.0, 0.0, 0.0}, 20.0);
  shuffle_ids(scene, random);
  const auto alone = search(scene);
  for (const int threads : {2, 3, 7})
    EXPECT_EQ(search(scene, {.threads = threads}), alone) << threads << " threads";
}

TEST(BroadPhase, GivesTheSameKeysForAnyOrderInMemory) {
  RandomStream random(8);
  Scene scene = cloud(random, 3'000, 5.0, 0.1, 0.5);
  const auto in_order = search(scene);
  for (std::size_t i = scene.ids.size(); i > 1; --i) {
    const auto other = static_cast<std::size_t>(random.below(static_cast<Index>(i)));
    std::swap(scene.ids[i - 1], scene.ids[other]);
    std::swap(scene.boxes[i - 1], scene.boxes[other]);
  }
  const auto mixed = search(scene);
  ASSERT_EQ(mixed.size(), in_order.size());
  for (std::size_t i = 0; i < mixed.size(); ++i) ASSERT_EQ(mixed[i].key, in_order[i].key);
}

TEST(BroadPhase, ListsEachPairOnceInAscendingOrder) {
  RandomStream random(9);
  Scene scene = cloud(random, 5'000, 5.0, 0.1, 0.5);
  shuffle_ids(scene, random);
  const auto pairs = search(scene);
  ASSERT_GT(pairs.size(), 1000u);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i > 0) {
      ASSERT_LT(pairs[i - 1].key, pairs[i].key);
    }
    ASSERT_EQ(low_id(pairs[i].key), scene.ids[static_cast<std::size_t>(pairs[i].a)]);
    ASSERT_EQ(high_id(pairs[i].key), scene.ids[static_cast<std::size_t>(pairs[i].b)]);
  }
}

TEST(BroadPhase, ReadsItsArraysInKernelsOnly) {
  RandomStream random(10);
  const Scene scene = cloud(random, 1000, 4.0, 0.1, 0.5);
  EXPECT_EQ(search(scene, {.space = Space::shadow}), search(scene));
}

TEST(BroadPhase, ListsTheSamePairsByRowsOfADeviceAndWhereARowIsTooLong) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    RandomStream random(seed);
    Scene scene = cloud(random, 500, 3.0, 0.05, 0.4);
    shuffle_ids(scene, random);
    ASSERT_EQ(search(scene, {.space = Space::shadow}), search(scene)) << "seed " << seed;
  }
  for (const Index together : {32, 33, 34, 150}) {  // one has so many partners, less itself
    RandomStream random(1);
    Scene scene = cloud(random, together, 0.01, 0.5, 0.5);
    shuffle_ids(scene, random);
    EXPECT_EQ(search(scene, {.space = Space::shadow}), search(scene)) << together;
  }
}

TEST(BroadPhase, FindsPointsAtTheSamePlaceAndNothingInAnEmptyScene) {
  Scene scene;
  EXPECT_TRUE(search(scene).empty());
  for (const double x : {1.0, 2.0, 1.0, 3.0, 0.0, 0.0}) scene.add({x, 5.0, x}, 0.0);
  EXPECT_EQ(search(scene), all_against_all(scene));
  EXPECT_EQ(search(scene).size(), 2u);
}

TEST(BroadPhase, UsesItsMemoryAgainAfterALargerScene) {
  BroadPhase broad_phase;
  Pairs pairs;
  RandomStream random(11);
  for (const Index count : {500, 20, 0, 300}) {
    const Scene scene = cloud(random, count, 2.0, 0.1, 0.3);
    broad_phase.search({}, scenes::buffer_of(scene.boxes), scenes::buffer_of(scene.ids), pairs);
    EXPECT_EQ(scenes::listed(pairs), all_against_all(scene));
  }
}

TEST(BroadPhase, LeavesKnownPairsOut) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    RandomStream random(seed);
    Scene scene = cloud(random, 120, seed % 2 == 0 ? 0.5 : 2.0, 0.1, 0.5);  // crowded, and less so
    shuffle_ids(scene, random);
    std::vector<GlobalId> ids = scene.ids;
    std::sort(ids.begin(), ids.end());
    const auto rank = [&](GlobalId id) {
      return static_cast<Index>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
    };
    std::vector<Index> starts(ids.size() + 1, 0), partners;
    std::vector<scenes::Expected> expected;
    for (const scenes::Expected& pair : all_against_all(scene)) {  // by lower, then by higher id
      const Index kind = random.below(3);
      if (kind != 0) expected.push_back(pair);
      if (kind == 2) continue;
      ++starts[static_cast<std::size_t>(rank(low_id(pair.key))) + 1];
      partners.push_back(kind == 0 ? rank(high_id(pair.key)) : -1);  // -1: not known after all
    }
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    const Buffer<Index> rows = scenes::buffer_of(starts), ends = scenes::buffer_of(partners);
    BroadPhase broad_phase;
    Pairs pairs;
    broad_phase.search({}, scenes::buffer_of(scene.boxes), scenes::buffer_of(scene.ids), pairs,
                       {rows.view(), ends.view()});
    ASSERT_EQ(scenes::listed(pairs), expected) << "seed " << seed;
  }
}

template <class Problem>
std::string message_of(const Scene& scene) {
  try {
    search(scene);
  } catch (const Problem& problem) {
    return problem.what();
  }
  return "no error";
}

TEST(BroadPhase, NamesTheElementWhoseBoxIsWrong) {
  RandomStream random(12);
  const Scene good = cloud(random, 3000, 4.0, 0.1, 0.5);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Scene scene = good;
    scene.ids[2100] = 98765;
    scene.boxes[2100].high.y = bad;
    EXPECT_NE(message_of<NumericsError>(scene).find("98765"), std::string::npos);
  }
  Scene swapped = good;
  swapped.boxes[17].low.z = swapped.boxes[17].high.z + 0.1;
  EXPECT_NE(message_of<InputError>(swapped).find("element 17 "), std::string::npos);
  Scene twins = good;
  twins.ids[2999] = 44;
  EXPECT_NE(message_of<InputError>(twins).find("44"), std::string::npos);
}

}  // namespace broad_phase_test
}  // namespace breccia
