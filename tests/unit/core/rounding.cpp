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

TEST(Rounding, adds_in_single_precision_to_one_of_two_neighbours_and_right_on_average) {
  constexpr int draws = 100'000;
  const float low = 0.1F;
  const double step = std::ldexp(1.0, -27);  // last bit of 0.1
  for (const double share : {0.0005, 0.03, 0.25, 0.5, 0.9, 1.3})
    for (const float sign : {1.0F, -1.0F}) {
      const Single more(sign * static_cast<float>(share * step));
      const int below = static_cast<int>(share);
      int up = 0;
      for (std::int64_t count = 0; count < draws; ++count) {
        const auto chance = chance_of(Single(sign * low), count);
        const double sum =
            sign * sum_by(chance, static_cast<int>(count % 32), Single(sign * low), more).v;
        const double steps = (sum - low) / step;
        ASSERT_TRUE(steps == below || steps == below + 1) << steps;
        up += steps > below ? 1 : 0;
      }
      const double part = share - below;
      EXPECT_NEAR(up, part * draws, 5.0 * std::sqrt(part * (1.0 - part) * draws)) << share;
    }
}

TEST(Rounding, a_sum_in_single_precision_with_nothing_stays) {
  for (const float number : {0.0F, 0.1F, -3.7F, 16777215.0F, 1.1e-30F, -7e20F})
    for (std::int64_t count = 0; count < 1000; ++count)
      EXPECT_EQ(sum_by(chance_of(Single(0.3F), count), 3, Single(number), Single(0.0F)).v, number);
}

TEST(Rounding, steps_far_below_the_last_bit_add_up_in_single_precision) {
  constexpr int steps = 1'000'000;
  Single sum(0.6F);
  const Single step(1e-9F);  // a sixtieth of the last bit
  for (std::int64_t count = 0; count < steps; ++count)
    sum = sum_by(chance_of(sum, count), 0, sum, step);
  const double bit = std::ldexp(1.0, -24);
  EXPECT_NEAR(sum.v, 0.6 + steps * 1e-9, 5.0 * std::sqrt(steps * 1e-9 * bit));
}

}  // namespace rounding_test
}  // namespace breccia
