// Flow through cracks by the cubic law: levels, transients, fronts, volume.

#include "fdem_shared/fluid/flow.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace breccia::fdem_shared {
namespace flow_test {

using FlowCell = LineCell;

/// A row of cracks from vertex 0 on.
std::vector<FlowCell> row(int count, double length, double aperture, double bulk, bool filled) {
  std::vector<FlowCell> cells;
  for (int i = 0; i < count; ++i) {
    cells.push_back({{i, i + 1}, length, aperture, bulk, 0.0});
    if (filled) cells.back().fluid = cells.back().room();
  }
  return cells;
}
double held(const std::vector<FlowCell>& cells) {
  double sum = 0.0;
  for (const FlowCell& c : cells) sum += c.fluid;
  return sum;
}

/// Pressure diffuses along a crack of constant width: p/p_0 = erfc(x / (2 sqrt(D t))), D = K a^2 /
/// (12 mu).
TEST(Flow, diffuses_as_the_cubic_law_says) {
  constexpr double mu = 1e-3, bulk = 2.2e9, a = 50e-6, p0 = 1e6, time = 2e-3;
  const double diffusivity = bulk * a * a / (12.0 * mu);
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const double length = k == 0 ? 0.1 : 0.05;
    std::vector<FlowCell> cells = row(k == 0 ? 100 : 200, length, a, bulk, true);
    const FlowSource source{{0}, false, p0};
    double came = 0.0;
    const double before = held(cells);
    for (int step = 0; step < 200; ++step) came += flow(cells, source, mu, time / 200.0).injected;
    EXPECT_NEAR(held(cells) - before, came, 1e-12 * before);
    error[k] = 0.0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double x = (static_cast<double>(i) + 0.5) * length;
      const double closed = std::erfc(x / (2.0 * std::sqrt(diffusivity * time)));
      error[k] = std::max(error[k], std::abs(cells[i].pressure() / p0 - closed));
    }
    EXPECT_NEAR(came, a * p0 / bulk * std::sqrt(4.0 * diffusivity * time / 3.141592653589793),
                0.02 * came);
  }
  EXPECT_LT(std::max(error[0], error[1]), 0.002);
}

/// From one level to another a^3 dp/(12 mu L) passes, and as much leaves as comes in.
TEST(Flow, leaves_at_another_level) {
  constexpr double a = 30e-6, mu = 1e-3;
  std::vector<FlowCell> cells = row(10, 0.01, a, 2.2e9, true);
  const FlowSource source{{0}, false, 3e5, {10}, 1e5};
  const double before = held(cells);
  const Flowed first = flow(cells, source, mu, 10.0);
  EXPECT_NEAR(held(cells) - before, first.injected - first.released, 1e-9 * first.injected);
  const Flowed then = flow(cells, source, mu, 1.0);
  const double rate = a * a * a * 2e5 / (12.0 * mu * 0.1);
  EXPECT_NEAR(then.injected, rate, 1e-6 * rate);
  EXPECT_NEAR(then.released, rate, 1e-6 * rate);
  EXPECT_NEAR(cells[4].pressure(), 3e5 - 2e5 * 0.45, 1.0);
}

/// Between two levels a^3 dp/(12 mu L) passes: here into a wide crack at the end, which stays empty
/// enough to have no pressure.
TEST(Flow, passes_by_the_cube_of_the_aperture) {
  for (const double a : {20e-6, 40e-6}) {
    std::vector<FlowCell> cells = row(10, 0.01, a, 2.2e9, true);
    cells.push_back({{10, 11}, 1.0, 1.0, 2.2e9, 0.0});
    const FlowSource source{{0}, false, 2e5};
    flow(cells, source, 1e-3, 0.2);
    const double before = cells.back().fluid;
    for (int k = 0; k < 100; ++k) flow(cells, source, 1e-3, 1e-3);
    const double q = (cells.back().fluid - before) / 0.1;
    EXPECT_NEAR(q, a * a * a * 2e5 / (12.0 * 1e-3 * 0.1), 1e-3 * q) << a;
  }
}

/// A given rate into dry cracks: a front at q t/a, pressure linear behind it.
TEST(Flow, fills_dry_cracks_with_a_front) {
  constexpr double a = 1e-4, q = 1e-4, mu = 1e-2;
  std::vector<FlowCell> cells = row(50, 0.02, a, 2.2e9, false);
  const FlowSource source{{0}, true, q};
  Flowed last;
  double came = 0.0;
  for (int k = 0; k < 500; ++k) {
    last = flow(cells, source, mu, 1e-3);
    came += last.injected;
  }
  EXPECT_NEAR(came, q * 0.5, 1e-12);
  EXPECT_NEAR(held(cells), came, 1e-15);
  const double front = q * 0.5 / a;  // 0.5 m: half of the row
  EXPECT_GT(cells[23].pressure(), 0.0);
  EXPECT_EQ(cells[26].pressure(), 0.0);
  EXPECT_NEAR(last.pressure, 12.0 * mu * q / (a * a * a) * front, 0.04 * last.pressure);
}

/// Cracks that meet at a vertex share what comes by their cubes; the order of cracks changes
/// nothing but rounding.
TEST(Flow, divides_by_cubes_where_cracks_meet) {
  std::vector<FlowCell> cells{
      {{0, 1}, 0.1, 1e-4, 1e9, 0.0}, {{1, 2}, 0.1, 1e-4, 1e9, 0.0}, {{3, 1}, 0.1, 2e-4, 1e9, 0.0}};
  cells[0].fluid = cells[0].room();
  const FlowSource source{{0}, false, 1e4};
  for (int k = 0; k < 10; ++k) flow(cells, source, 1e-2, 1e-4);
  EXPECT_NEAR(cells[2].fluid / cells[1].fluid, 8.0, 1e-9);
}

/// Steps in which pressure would go along all cracks thousands of times: level.
TEST(Flow, is_stable_where_cracks_are_wide) {
  std::vector<FlowCell> cells = row(20, 0.05, 5e-3, 2.2e9, true);
  const FlowSource source{{0}, false, 1e5};
  for (int k = 0; k < 20; ++k) flow(cells, source, 1e-3, 1e-3);
  for (const FlowCell& c : cells) {
    EXPECT_NEAR(c.pressure(), 1e5, 1.0);
  }
}

}  // namespace flow_test
}  // namespace breccia::fdem_shared
