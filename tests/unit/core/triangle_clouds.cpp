// The shared search over triangles in the plane, against every triangle with every other and
// against the no-binary search, written here once more in its plainest form.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "unit/core/scenes.hpp"

namespace breccia {
namespace triangle_clouds_test {

using scenes::RandomStream;
using scenes::Scene;

using PairSet = std::set<std::pair<Index, Index>>;

/// Triangles of sizes within a factor of `spread`, in a square or in a few heaps, boxed with a
/// margin.
Scene triangle_cloud(RandomStream& random, Index count, double spread, bool heaped) {
  Scene scene;
  std::vector<Vec3> heaps;
  for (int i = 0; i < 4; ++i) heaps.push_back(random.inside(3.0));
  for (Index i = 0; i < count; ++i) {
    const Vec3 centre = heaped
                            ? heaps[static_cast<std::size_t>(random.below(4))] + random.inside(0.4)
                            : random.inside(2.0);
    const double size = 0.3 * std::pow(spread, random.uniform(-1.0, 0.0));
    Box box{{1e300, 1e300, 0.0}, {-1e300, -1e300, 0.0}};
    double angle = random.uniform(0.0, 6.3);
    for (int k = 0; k < 3; ++k) {
      const double x = centre.x + size * std::cos(angle), y = centre.y + size * std::sin(angle);
      constexpr double margin = 0.02;
      box.low = {std::min(box.low.x, x - margin), std::min(box.low.y, y - margin), 0.0};
      box.high = {std::max(box.high.x, x + margin), std::max(box.high.y, y + margin), 0.0};
      angle += random.uniform(1.0, 2.5);
    }
    scene.boxes.push_back(box);
    scene.ids.push_back(i);
  }
  return scene;
}

PairSet by_comparing_all(const Scene& scene) {
  PairSet pairs;
  for (const scenes::Expected& e : scenes::all_against_all(scene)) pairs.insert({e.a, e.b});
  return pairs;
}

/// No-binary search (Munjiza and Andrews 1998): square cells as wide as the largest element, each
/// in the cell of its middle; rows as lists, and within two rows columns as lists. A cell looks at
/// itself and at four neighbours, so each pair of cells is seen once.
PairSet by_no_binary_search(const Scene& scene) {
  double width = 0.0;
  for (const Box& b : scene.boxes)
    width = std::max({width, b.high.x - b.low.x, b.high.y - b.low.y});
  using Column = std::map<long, std::vector<Index>>;  // elements of a row by their column
  std::map<long, Column> rows;
  for (std::size_t i = 0; i < scene.boxes.size(); ++i) {
    const Vec3 middle = 0.5 * (scene.boxes[i].low + scene.boxes[i].high);
    rows[std::lround(std::floor(middle.y / width))][std::lround(std::floor(middle.x / width))]
        .push_back(static_cast<Index>(i));
  }
  PairSet pairs;
  const auto compare = [&](Index i, Index j) {
    if (scenes::share_a_point(scene.boxes[static_cast<std::size_t>(i)],
                              scene.boxes[static_cast<std::size_t>(j)])) {
      EXPECT_TRUE(pairs.insert(std::minmax(i, j)).second) << "seen twice: " << i << ", " << j;
    }
  };
  for (const auto& [y, row] : rows)
    for (const auto& [x, cell] : row) {
      for (std::size_t i = 0; i < cell.size(); ++i)
        for (std::size_t j = i + 1; j < cell.size(); ++j) compare(cell[i], cell[j]);
      for (const std::array<long, 2> step :
           {std::array<long, 2>{-1, 0}, {-1, -1}, {0, -1}, {1, -1}}) {
        const auto other_row = rows.find(y + step[1]);
        if (other_row == rows.end()) continue;
        const auto other = other_row->second.find(x + step[0]);
        if (other == other_row->second.end()) continue;
        for (const Index i : cell)
          for (const Index j : other->second) compare(i, j);
      }
    }
  return pairs;
}

TEST(TriangleClouds, the_search_finds_the_pairs_of_brute_force_and_of_no_binary_search) {
  std::size_t found = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    RandomStream random(seed);
    const Scene scene =
        triangle_cloud(random, 2 + random.below(60), seed % 3 == 0 ? 30.0 : 2.0, seed % 2 == 0);
    PairSet here;
    for (const scenes::Expected& e : scenes::search(scene))
      ASSERT_TRUE(here.insert({e.a, e.b}).second) << "seed " << seed << ": twice";
    ASSERT_EQ(here, by_comparing_all(scene)) << "seed " << seed;
    ASSERT_EQ(here, by_no_binary_search(scene)) << "seed " << seed;
    found += here.size();
  }
  EXPECT_GT(found, 30'000U);
}

}  // namespace triangle_clouds_test
}  // namespace breccia
