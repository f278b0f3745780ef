// Smooth outlines of spheres, after the picture is shaded.

#include <algorithm>
#include <array>
#include <cmath>

#include "exec/tasks.hpp"
#include "io/picture/shading.hpp"

namespace breccia {
namespace {

/// Share of the pixel at (u, v) that a sphere covers, as if its outline were straight there.
float coverage(const ScreenSphere& sphere, float u, float v) {
  const float du = u - sphere.u, dv = v - sphere.v;
  return std::clamp(0.5F + sphere.radius - std::sqrt(du * du + dv * dv), 0.0F, 1.0F);
}

const ScreenSphere* sphere_of(std::span<const ItemLook> looks, std::int32_t item) {
  if (item == Canvas::none) return nullptr;
  const ScreenSphere& sphere = looks[static_cast<std::size_t>(item)].sphere;
  return sphere.radius > 0.0F ? &sphere : nullptr;
}

/// The share of a neighbour in the colour of a pixel.
struct Mix {
  std::ptrdiff_t neighbour = 0;  ///< distance in the canvas
  float share = 0.0F;
};

Mix mix_at(const Canvas& canvas, std::span<const ItemLook> looks, int x, int y) {
  const auto place = static_cast<std::ptrdiff_t>(canvas.row(y)) + x;
  const std::int32_t own_item = canvas.item[static_cast<std::size_t>(place)];
  const float own_depth = canvas.depth[static_cast<std::size_t>(place)];
  const ScreenSphere* own = sphere_of(looks, own_item);
  const float u = static_cast<float>(x) + 0.5F, v = static_cast<float>(y) + 0.5F;
  const std::array<std::ptrdiff_t, 4> steps{-1, 1, -canvas.stride, canvas.stride};
  Mix mix;
  for (const std::ptrdiff_t step : steps) {
    const auto there = static_cast<std::size_t>(place + step);
    if (canvas.item[there] == own_item) continue;
    const bool nearer = canvas.depth[there] > own_depth;
    const ScreenSphere* front = nearer ? sphere_of(looks, canvas.item[there]) : own;
    if (front == nullptr) continue;
    const float covered = coverage(*front, u, v);
    const float share = nearer ? std::min(covered, 0.5F) : 1.0F - covered;
    if (share > mix.share && share <= 0.5F) mix = {step, share};
  }
  return mix;
}

void smooth_row(Image& image, const std::vector<std::uint8_t>& before, const Canvas& canvas,
                std::span<const ItemLook> looks, int y) {
  const std::int32_t* const item = &canvas.item[canvas.row(y)];
  for (int x = 1; x + 1 < canvas.width; ++x) {
    const std::int32_t own = item[x];
    const bool edge = (item[x - 1] != own) | (item[x + 1] != own) |
                      (item[x - canvas.stride] != own) | (item[x + canvas.stride] != own);
    if (!edge) continue;
    const Mix mix = mix_at(canvas, looks, x, y);
    if (mix.share <= 0.0F) continue;
    const std::ptrdiff_t rows = mix.neighbour / canvas.stride;
    const std::ptrdiff_t here = static_cast<std::ptrdiff_t>(y) * canvas.width + x;
    const std::ptrdiff_t there = here + rows * canvas.width + (rows == 0 ? mix.neighbour : 0);
    for (std::ptrdiff_t c = 0; c < 3; ++c) {
      const float mine = before[static_cast<std::size_t>(3 * here + c)];
      const float theirs = before[static_cast<std::size_t>(3 * there + c)];
      image.rgb[static_cast<std::size_t>(3 * here + c)] =
          static_cast<std::uint8_t>(mine + mix.share * (theirs - mine) + 0.5F);
    }
  }
}

}  // namespace

void smooth_outlines(Image& image, const Canvas& canvas, std::span<const ItemLook> looks,
                     int threads) {
  constexpr int band = 16;  // rows that one thread takes
  const std::vector<std::uint8_t> before = image.rgb;
  for_each_task(threads, (canvas.height + band - 1) / band, [&](int number) {
    const int end = std::min(canvas.height - 1, band * (number + 1));
    for (int y = std::max(1, band * number); y < end; ++y)
      smooth_row(image, before, canvas, looks, y);
  });
}

}  // namespace breccia
