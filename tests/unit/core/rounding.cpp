// Rounding by chance: to one of two neighbours, and right on average.

#include "math/rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace breccia {
namespace rounding_test {

TEST(Rounding, leaves_what_single_precision_holds) {
  for (const double number : {0.0, -0.0, 1.0, -3.5, 0x1.8p-100, 16777215.0, 1.0 / 0.0})
    for (std::int64_t count = 0; count < 1000; ++count)
      EXPECT_EQ(rounded_by(chance_of(0.1, count), number), number);
}

TEST(Rounding, takes_each_neighbour_as_often_as_the_number_is_near_to_it) {
  constexpr int draws = 100'000;
  const double low = static_cast<float>(0.1), step = std::ldexp(1.0, -27);
  for (const double share : {0.0005, 0.03, 0.25, 0.5, 0.9})
    for (const double sign : {1.0, -1.0}) {
      const double number = sign * (low + share * step);
      int up = 0;
      for (std::int64_t count = 0; count < draws; ++count) {
        const double rounded = sign * rounded_by(chance_of(number, count), number);
        ASSERT_TRUE(rounded == low || rounded == low + step);
        up += rounded > low ? 1 : 0;
      }
      // Five standard deviations of independent draws.
      EXPECT_NEAR(up, share * draws, 5.0 * std::sqrt(share * (1.0 - share) * draws)) << share;
    }
}

TEST(Rounding, draws_for_the_components_of_a_vector_apart) {
  constexpr int draws = 100'000;
  const double number = static_cast<float>(0.1) + 0.5 * std::ldexp(1.0, -27);
  int alike = 0;
  for (std::int64_t count = 0; count < draws; ++count) {
    const Vec3 v = rounded_by(chance_of(number, count), 18, Vec3{number, number, number});
    alike += v.x == v.y ? 1 : 0;
  }
  // Components share all but six bits: they go together by 1 in 64 more than by chance.
  EXPECT_NEAR(alike, 0.5 * draws, draws / 64.0 + 5.0 * std::sqrt(0.25 * draws));
}

}  // namespace rounding_test
}  // namespace breccia
