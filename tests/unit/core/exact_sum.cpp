#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/energy.hpp"

namespace breccia {
namespace exact_sum_test {

double sum_of(const std::vector<double>& terms) {
  ExactSum sum;
  for (const double term : terms) sum.add(term);
  return sum.value();
}

TEST(ExactSum, terms_within_its_range_add_up_in_any_order) {
  EXPECT_EQ(sum_of({9e18, -9e18, 0.5}), 0.5);
  EXPECT_EQ(sum_of({0.5, -9e18, 9e18}), 0.5);
  EXPECT_EQ(sum_of({-9.2e18}), -9.2e18);
}

TEST(ExactSum, a_term_beyond_its_range_makes_it_infinite_in_any_order) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double wrong : {9.3e18, -9.3e18, 1e300, nan, HUGE_VAL, -HUGE_VAL}) {
    EXPECT_TRUE(std::isinf(sum_of({wrong}))) << wrong;
    EXPECT_TRUE(std::isinf(sum_of({1.0, wrong, -1.0}))) << wrong;
    EXPECT_TRUE(std::isinf((ExactSum(1.0) + ExactSum(wrong)).value())) << wrong;
    EXPECT_TRUE(std::isinf((ExactSum(wrong) + ExactSum(wrong)).value())) << wrong;
  }
}

}  // namespace exact_sum_test
}  // namespace breccia
