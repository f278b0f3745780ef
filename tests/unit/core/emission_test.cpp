// Events of acoustic emission: which breaks are one, moments, magnitudes, b.

#include "core/emission.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "math/constants.hpp"

namespace breccia {
namespace emission_test {

Break at(double time, double x, double moment = 1.0) {
  return {time, {x, 0.0, 0.0}, {moment, 0.0, 0.0, 0.0, 0.0, 0.0}, 2.0};
}

TEST(Emission, takes_what_is_near_in_place_and_time_as_one) {
  const std::vector<Break> breaks{at(3.0, 0.9, 3.0), at(0.0, 0.0), at(1.0, 0.5),
                                  at(9.0, 0.2),      at(1.0, 5.0), at(1.5, 5.0, 3.0)};
  const std::vector<EmissionEvent> events = events_of(breaks, 0.6, 2.0);
  ASSERT_EQ(events.size(), 3U);  // a chain of three, two far away, one that comes late
  EXPECT_EQ(events[0].breaks, 3);
  EXPECT_DOUBLE_EQ(events[0].duration, 3.0);
  EXPECT_DOUBLE_EQ(events[0].moment.xx, 5.0);
  EXPECT_DOUBLE_EQ(events[0].energy, 6.0);
  EXPECT_NEAR(events[0].place.x, (0.5 + 3.0 * 0.9) / 5.0, 1e-12);
  EXPECT_EQ(events[1].breaks, 2);
  EXPECT_EQ(events[2].breaks, 1);
  EXPECT_EQ(events_of(breaks, 0.6, 0.4).size(), 6U);
  EXPECT_EQ(events_of(breaks, 0.25, 100.0).size(), 4U);
}

/// Far more breaks than cells: each against each.
TEST(Emission, finds_the_pairs_that_a_full_search_finds) {
  std::vector<Break> breaks;
  const Random random{5, 1};
  auto draw = [&, i = std::uint64_t{0}]() mutable { return random.uniform(i++); };
  for (int i = 0; i < 400; ++i) {
    Break b = at(draw(), 0.0);
    b.place = {draw() - 0.5, draw() - 0.5, 0.2 * draw()};
    breaks.push_back(b);
  }
  constexpr double distance = 0.06, window = 0.1;
  std::vector<std::size_t> root(breaks.size());
  for (std::size_t i = 0; i < root.size(); ++i) root[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < root.size(); ++i)
      for (std::size_t j = 0; j < root.size(); ++j) {
        if (norm(breaks[i].place - breaks[j].place) > distance ||
            std::abs(breaks[i].time - breaks[j].time) > window || root[j] >= root[i])
          continue;
        root[i] = root[j];
        changed = true;
      }
  }
  std::size_t events = 0;
  for (std::size_t i = 0; i < root.size(); ++i) events += root[i] == i ? 1U : 0U;
  EXPECT_GT(events, 20U);
  EXPECT_LT(events, 390U);
  EXPECT_EQ(events_of(breaks, distance, window).size(), events);
}

/// Slip of 1 mm on 1 m2 of rock of 30 GPa: M_0 = 3e7 N m, M_w = 2/3 (7.477 - 9.1) = -1.08.
TEST(Emission, has_the_magnitude_of_its_moment) {
  EmissionEvent e;
  e.moment.xy = 30e9 * 1e-3;
  EXPECT_DOUBLE_EQ(e.scalar(), 3e7);
  EXPECT_NEAR(e.magnitude(), -1.0819, 1e-4);
  EXPECT_NEAR(e.isotropic(), 0.0, 1e-12);
}

/// A crack that opens: eigenvalues lambda + 2 mu, lambda, lambda, in any direction. With lambda =
/// mu tr = 5, deviator 4/3, -2/3, -2/3: 5/(5 + 8/3).
TEST(Emission, tells_what_opens_from_what_slides) {
  for (const double t : {0.0, 0.4, 1.3}) {
    const double c = std::cos(t), s = std::sin(t);
    EmissionEvent e;
    e.moment = {1.0 + 2.0 * c * c, 1.0 + 2.0 * s * s, 1.0, 0.0, 0.0, 2.0 * c * s};
    EXPECT_NEAR(e.isotropic(), 5.0 / (5.0 + 8.0 / 3.0), 1e-7);
    e.moment = {-1.0, -1.0, -1.0, 0.0, 0.0, 0.0};
    EXPECT_NEAR(e.isotropic(), -1.0, 1e-7);
  }
}

/// A catalogue with b = 1.2 from -3 on, and with half of the events missing below that.
TEST(Emission, finds_the_b_value_of_a_catalogue) {
  std::vector<double> magnitudes;
  const Random random{7, 1};
  auto draw = [&, i = std::uint64_t{0}]() mutable { return random.uniform(i++); };
  constexpr int count = 4000;
  for (int i = 0; i < count; ++i) magnitudes.push_back(-3.0 - std::log10(1.0 - draw()) / 1.2);
  for (int i = 0; i < 300; ++i) magnitudes.push_back(-3.5 + 0.5 * draw());
  const std::optional<Frequency> f = frequency_of(magnitudes);
  ASSERT_TRUE(f);
  EXPECT_NEAR(f->completeness, -3.0, 1e-9);
  EXPECT_EQ(f->count, count);
  EXPECT_NEAR(f->deviation, 1.2 / std::sqrt(count), 0.1 * 1.2 / std::sqrt(count));
  EXPECT_NEAR(f->b, 1.2, 3.0 * f->deviation);
  magnitudes.resize(10);
  EXPECT_FALSE(frequency_of(magnitudes));
  EXPECT_FALSE(frequency_of({}));
}

}  // namespace emission_test
}  // namespace breccia
