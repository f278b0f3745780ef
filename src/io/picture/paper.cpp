#include "io/picture/paper.hpp"

#include <algorithm>
#include <cmath>

#include "io/picture/font.hpp"
#include "io/picture/pixel.hpp"

namespace breccia {
void ImagePaper::fill(int left, int top, int right, int bottom, const Color& color) {
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) mix_pixel(image_, x, y, color, 1.0F);
  }
}

void ImagePaper::veil(int left, int top, int right, int bottom, int scale) {
  constexpr Color white{1.0F, 1.0F, 1.0F};
  constexpr float share = 0.8F;
  const int edge = 4 * scale;  // around it
  for (int y = top - edge; y < bottom + edge; ++y) {
    for (int x = left - edge; x < right + edge; ++x) mix_pixel(image_, x, y, white, share);
  }
}

/// A smooth straight stroke: a pixel takes the colour by its distance from the line.
void ImagePaper::stroke(double from_x, double from_y, double to_x, double to_y, double thick,
                        const Color& color) {
  const double along_x = to_x - from_x, along_y = to_y - from_y;
  const double square = std::max(1e-12, along_x * along_x + along_y * along_y);
  const double reach = 0.5 * thick + 1.0;
  const int right = static_cast<int>(std::max(from_x, to_x) + reach);
  const int bottom = static_cast<int>(std::max(from_y, to_y) + reach);
  for (int y = static_cast<int>(std::min(from_y, to_y) - reach); y <= bottom; ++y) {
    for (int x = static_cast<int>(std::min(from_x, to_x) - reach); x <= right; ++x) {
      const double dx = x + 0.5 - from_x, dy = y + 0.5 - from_y;
      const double share = std::clamp((dx * along_x + dy * along_y) / square, 0.0, 1.0);
      const double off_x = dx - share * along_x, off_y = dy - share * along_y;
      const double distance = std::sqrt(off_x * off_x + off_y * off_y);
      const double covered = std::clamp(0.5 * thick + 0.5 - distance, 0.0, 1.0);
      if (covered > 0.0) mix_pixel(image_, x, y, color, static_cast<float>(covered));
    }
  }
}

void ImagePaper::write(int x, int y, std::string_view text, int scale, const Color& color) {
  draw_text(image_, x, y, text, scale, color);
}

}  // namespace breccia
