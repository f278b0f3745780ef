// Random numbers are the published ones, and depend on nothing but seed, stream and index.

#include "core/random.hpp"

#include <gtest/gtest.h>

namespace breccia {
namespace random_test {

TEST(Random, PhiloxGivesTheNumbersItsAuthorsPublished) {
  using Four = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}),
            (Four{0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U}));
  const std::uint32_t ones = 0xffffffffU;
  EXPECT_EQ(philox({ones, ones, ones, ones}, {ones, ones}),
            (Four{0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU}));
  EXPECT_EQ(
      philox({0x243f6a88U, 0x85a308d3U, 0x13198a2eU, 0x03707344U}, {0xa4093822U, 0x299f31d0U}),
      (Four{0xd16cfe09U, 0x94fdccebU, 0x5001e420U, 0x24126ea1U}));
}

TEST(Random, ValuesFillTheUnitIntervalEvenly) {
  const Random random{7, 3};
  double sum = 0.0, squares = 0.0;
  const int count = 100000;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double u = random.uniform(i);
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / count, 0.5, 0.005);  // five standard deviations
  EXPECT_NEAR(squares / count, 1.0 / 3, 0.005);
}

TEST(Random, SeedStreamIndexAndDrawEachChangeTheValue) {
  const double u = Random{1, 2}.uniform(3, 4);
  EXPECT_NE(u, (Random{2, 2}.uniform(3, 4)));
  EXPECT_NE(u, (Random{1, 3}.uniform(3, 4)));
  EXPECT_NE(u, (Random{1, 2}.uniform(4, 4)));
  EXPECT_NE(u, (Random{1, 2}.uniform(3, 5)));
  EXPECT_NE(u, (Random{1ULL << 40 | 1, 2}.uniform(3, 4)));
  EXPECT_EQ(u, (Random{1, 2}.uniform(3, 4)));
}

}  // namespace random_test
}  // namespace breccia
