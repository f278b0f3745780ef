#pragma once
// A pixel of an image takes a share of a colour.

#include <array>

#include "io/picture/color_map.hpp"
#include "io/picture/picture.hpp"

namespace breccia {

inline void mix_pixel(Image& image, int x, int y, const Color& color, float share) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  const std::array channels{color.red, color.green, color.blue};
  auto* pixel =
      &image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(x))];
  for (std::size_t c = 0; c < 3; ++c) {
    const float before = static_cast<float>(pixel[c]);
    pixel[c] = static_cast<std::uint8_t>(before + share * (255.0F * channels[c] - before) + 0.5F);
  }
}

}  // namespace breccia
