// Cost of a search on one core: printed, and bounded by its comparisons, which no machine
// changes.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <ctime>

#include "core/travel.hpp"
#include "unit/core/scenes.hpp"

namespace breccia {
namespace search_cost_test {

/// Spheres of radii 0.8 to 1.2 at the density of a packing (60 % of the volume), with a skin of a
/// tenth of a radius.
std::int64_t search_packing(Index count) {
  scenes::RandomStream random(42);
  const double half_width = 0.5 * std::cbrt(count * 4.0 / 3.0 * 3.14159 * 1.04 / 0.6);
  std::vector<Vec3> centre;
  std::vector<double> radius, margin;
  std::vector<GlobalId> ids;
  for (Index i = 0; i < count; ++i) {
    centre.push_back(random.inside(half_width));
    radius.push_back(random.uniform(0.8, 1.2));
    margin.push_back(0.05);
    ids.push_back(i);
  }
  Buffer<Box> boxes;
  sphere_boxes({}, scenes::buffer_of(centre), scenes::buffer_of(radius), scenes::buffer_of(margin),
               boxes);
  BroadPhase broad_phase;
  Pairs pairs;
  double best = 1e9;
  for (int repeat = 0; repeat < 3; ++repeat) {
    const std::clock_t start = std::clock();  // processor time: others may use the machine
    broad_phase.search({}, boxes, scenes::buffer_of(ids), pairs);
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::printf(
      "search of %d spheres: %.2f ms, %.1f ns an element, %d pairs, %.1f comparisons each\n", count,
      1e3 * best, 1e9 * best / count, pairs.size(),
      static_cast<double>(broad_phase.tested({})) / count);
  return broad_phase.tested({});
}

TEST(SearchCost, IsLinearInTheElements) {
  const std::int64_t slab = search_packing(14'274), million = search_packing(1'000'000);
  EXPECT_LT(slab, 25 * 14'274);
  EXPECT_LT(million, 25 * 1'000'000);
}

}  // namespace search_cost_test
}  // namespace breccia
