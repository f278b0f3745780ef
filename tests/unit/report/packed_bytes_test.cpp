#include "report/packed_bytes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/report/unpacked.hpp"

namespace breccia::report {
namespace packed_bytes_test {

TEST(PackedBytes, Base64IsThatOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

TEST(PackedBytes, DeflatedBytesComeBack) {
  const std::string bytes(5000, 'x');
  const std::string packed = deflated(bytes);
  EXPECT_LT(packed.size(), 100U);
  EXPECT_EQ(test::inflated(packed), bytes);
}

TEST(PackedBytes, PlanesHoldLowBytesFirst) {
  Planes planes;
  planes.add({0x010203, 0x0a0b0c}, 3);
  EXPECT_EQ(planes.bytes(), std::string("\x03\x0c\x02\x0b\x01\x0a"));
}

TEST(PackedBytes, SmallDifferencesBecomeSmallNumbersWhateverTheirSign) {
  for (const int width : {1, 2, 3, 4}) {
    EXPECT_EQ(zigzag(0U, width), 0U);
    EXPECT_EQ(zigzag(~0U, width), 1U);
    EXPECT_EQ(zigzag(1U, width), 2U);
    EXPECT_EQ(zigzag(static_cast<std::uint32_t>(-64), width), 127U);
  }
  EXPECT_EQ(zigzag(0x8000U, 2), 0xffffU);
}

TEST(PackedBytes, ALinearScaleIsRightToHalfAStep) {
  const Scale scale{-2.0F, 3.0F, 1023, false};
  for (float value = -2.0F; value <= 3.0F; value += 0.0371F) {
    const double back = -2.0 + 5.0 * scale.step_of(value) / 1023.0;
    EXPECT_NEAR(back, value, 0.5 * 5.0 / 1023.0 + 1e-6);
  }
  EXPECT_EQ(scale.step_of(-9.0F), 0U);
  EXPECT_EQ(scale.step_of(9.0F), 1023U);
}

TEST(PackedBytes, ARootScaleKeepsSmallValuesBesideAPeak) {
  const Scale scale{0.0F, 1e6F, 1023, true};
  for (const double value : {10.0, 300.0, 2e4, 7e5}) {
    const double root = 1e3 * scale.step_of(static_cast<float>(value)) / 1023.0;
    EXPECT_NEAR(root * root, value, 1e3 * std::sqrt(value) / 1023.0 + 1.0);
  }
}

TEST(PackedBytes, WhatIsNoNumberCountsAsZero) {
  EXPECT_EQ((Scale{-1.0F, 1.0F, 200, false}.step_of(NAN)), 100U);
}

}  // namespace packed_bytes_test
}  // namespace breccia::report
