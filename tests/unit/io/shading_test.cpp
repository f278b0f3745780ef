// A canvas that is lit and made smaller at one go, against one after the other.

#include "io/picture/shading.hpp"

#include <gtest/gtest.h>

#include <random>

namespace breccia {
namespace shading_test {

/// Patches of items at some heights, ground between them.
Canvas patches(int width, int height, std::size_t items, bool level) {
  Canvas canvas(width, height);
  std::mt19937 random(7);
  const auto below = [&](int limit) { return static_cast<int>(random() % limit); };
  for (int k = 0; k < 60; ++k) {
    const int left = below(width), top = below(height);
    const auto item = static_cast<std::int32_t>(below(static_cast<int>(items)));
    const float depth = level ? 3.0F : static_cast<float>(below(40));
    for (int y = top; y < std::min(height, top + 1 + below(70)); ++y)
      for (int x = left; x < std::min(width, left + 1 + below(90)); ++x) {
        const std::size_t at = canvas.row(y) + static_cast<std::size_t>(x);
        canvas.item[at] = item;
        canvas.depth[at] = depth;
      }
  }
  return canvas;
}
std::vector<ItemLook> looks(std::size_t count, bool with_sphere) {
  std::vector<ItemLook> all(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(count);
    all[i].color = {share, 1.0F - share, 0.3F + 0.7F * share};
  }
  if (with_sphere) all[1].sphere = {100.0F, 80.0F, 3.0F, 60.0F};
  return all;
}
std::vector<std::uint8_t> means(const Image& large, int fine) {
  std::vector<std::uint8_t> rgb;
  for (int y = 0; y < large.height / fine; ++y)
    for (int x = 0; x < large.width / fine; ++x)
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int k = 0; k < fine * fine; ++k)
          sum += large.rgb[static_cast<std::size_t>(
              3 * ((fine * y + k / fine) * large.width + fine * x + k % fine) + c)];
        rgb.push_back(static_cast<std::uint8_t>((sum + fine * fine / 2) / (fine * fine)));
      }
  return rgb;
}

TEST(Shading, of_a_smaller_picture_is_the_mean_of_the_larger_one) {
  for (const bool level : {true, false})
    for (const bool with_sphere : {false, true})
      for (const int fine : {2, 3}) {
        // Light looks three pixels far in the first canvas, six in the second.
        for (const int height : {300, 1290}) {
          const Canvas canvas = patches(fine * 137, height, 9, level);
          const std::vector<ItemLook> all = looks(9, with_sphere);
          const Image whole = shade(canvas, all, std::nullopt, 10.0F, 1, 200);
          const Image small = shade_reduced(canvas, all, std::nullopt, 10.0F, fine, 3, 200);
          EXPECT_EQ(small.width, 137);
          EXPECT_EQ(small.rgb, means(whole, fine)) << level << with_sphere << fine << height;
        }
      }
}

}  // namespace shading_test
}  // namespace breccia
