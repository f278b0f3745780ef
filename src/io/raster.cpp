#include "io/raster.hpp"

#include <algorithm>
#include <cmath>

namespace breccia {
namespace {

/// First pixel whose centre is at or after `place`, and the last whose centre is at or before it.
int first_pixel(double place) {
  return static_cast<int>(std::ceil(std::clamp(place, -1e6, 1e6) - 0.5));
}
int last_pixel(double place) {
  return static_cast<int>(std::floor(std::clamp(place, -1e6, 1e6) - 0.5));
}
double centre_of(int pixel) {
  return pixel + 0.5;
}

void put(Canvas& canvas, int x, int y, double depth, std::int32_t item) {
  if (x < 0 || y < 0 || x >= canvas.width || y >= canvas.height) return;
  const std::size_t place = canvas.row(y) + static_cast<std::size_t>(x);
  if (static_cast<float>(depth) <= canvas.depth[place]) return;
  canvas.depth[place] = static_cast<float>(depth);
  canvas.item[place] = item;
}

/// One row of a whole sphere, block by block: pixels off the sphere get a depth that never shows.
void draw_row(float* depth, std::int32_t* item, int first_block, int last_block,
              const ScreenSphere& sphere, float half_chord_squared, std::int32_t number) {
  for (int b = first_block; b <= last_block; ++b) {
    float* const depth_here = depth + b * Canvas::block;
    std::int32_t* const item_here = item + b * Canvas::block;
    const float start = static_cast<float>(b * Canvas::block) + 0.5F - sphere.u;
    for (int k = 0; k < Canvas::block; ++k) {
      const float offset = start + static_cast<float>(k);
      const float height_squared = half_chord_squared - offset * offset;
      const float surface = sphere.depth + std::sqrt(std::max(height_squared, 0.0F));
      const bool shows = (height_squared >= 0.0F) & (surface > depth_here[k]);
      depth_here[k] = shows ? surface : depth_here[k];
      item_here[k] = shows ? number : item_here[k];
    }
  }
}

/// One row of a sphere that the plane crosses: its kept surface, and where that was dropped the cut
/// face if the viewer can see it.
void draw_cut_row(Canvas& canvas, int y, int first, int last, const ScreenSphere& sphere,
                  float half_chord_squared, std::int32_t number, const ScreenClip& clip) {
  for (int x = first; x <= last; ++x) {
    const float offset = static_cast<float>(x) + 0.5F - sphere.u;
    const double height = std::sqrt(std::max(half_chord_squared - offset * offset, 0.0F));
    double surface = sphere.depth + height;
    const double beyond = clip.beyond(centre_of(x), centre_of(y), surface);
    if (beyond > 0.0) {
      if (clip.nd <= 1e-9) continue;
      surface -= beyond / clip.nd;
      if (surface < sphere.depth - height) continue;
    }
    put(canvas, x, y, surface, number);
  }
}

}  // namespace

Canvas::Canvas(int wide, int high)
    : width(wide), height(high), stride((wide + block - 1) / block * block) {
  const std::size_t size = row(high);
  depth.assign(size, empty);
  item.assign(size, none);
}

void draw_sphere(Canvas& canvas, const ScreenSphere& sphere, std::int32_t item,
                 const std::optional<ScreenClip>& clip) {
  const auto [u, v, depth, r] = sphere;
  if (!(r > 0.0F) || !(std::fabs(depth) < 1e20F)) return;
  if (!(u + r > 0.0F && u - r < static_cast<float>(canvas.width))) return;
  if (!(v + r > 0.0F && v - r < static_cast<float>(canvas.height))) return;
  bool crossed = false;
  if (clip) {
    const double beyond = clip->beyond(u, v, depth);
    if (beyond >= r) return;
    crossed = beyond > -r;
  }
  const int top = std::max(0, first_pixel(v - r));
  const int bottom = std::min(canvas.height - 1, last_pixel(v + r));
  for (int y = top; y <= bottom; ++y) {
    const float dv = static_cast<float>(y) + 0.5F - v;
    const float half_chord_squared = r * r - dv * dv;
    if (half_chord_squared <= 0.0F) continue;
    const float half_chord = std::sqrt(half_chord_squared);
    const int first = std::max(0, first_pixel(u - half_chord));
    const int last = std::min(canvas.width - 1, last_pixel(u + half_chord));
    if (first > last) continue;
    if (crossed) {
      draw_cut_row(canvas, y, first, last, sphere, half_chord_squared, item, *clip);
    } else {
      draw_row(&canvas.depth[canvas.row(y)], &canvas.item[canvas.row(y)], first / Canvas::block,
               last / Canvas::block, sphere, half_chord_squared, item);
    }
  }
}

void draw_line(Canvas& canvas, const ScreenPoint& a, const ScreenPoint& b, int thickness,
               std::int32_t item, const std::optional<ScreenClip>& clip) {
  const double du = b.u - a.u, dv = b.v - a.v;
  const double length = std::max(std::fabs(du), std::fabs(dv));
  const double reach = thickness + 1.0;
  const bool in_sight = std::max(a.u, b.u) > -reach && std::min(a.u, b.u) < canvas.width + reach &&
                        std::max(a.v, b.v) > -reach && std::min(a.v, b.v) < canvas.height + reach;
  if (!in_sight || !(length < 1e5) || !std::isfinite(a.depth + b.depth)) return;
  const bool steep = std::fabs(dv) > std::fabs(du);
  const int steps = std::max(1, static_cast<int>(std::ceil(length)));
  for (int step = 0; step <= steps; ++step) {
    const double share = static_cast<double>(step) / steps;
    const double u = a.u + share * du, v = a.v + share * dv;
    const double depth = a.depth + share * (b.depth - a.depth);
    if (clip && clip->beyond(u, v, depth) > 0.0) continue;
    const double across = (steep ? u : v) - 0.5 * thickness;
    const int first = static_cast<int>(std::floor(across + 0.5));
    const int along = static_cast<int>(std::floor(steep ? v : u));
    for (int k = first; k < first + thickness; ++k) {
      put(canvas, steep ? k : along, steep ? along : k, depth, item);
    }
  }
}

void draw_triangle(Canvas& canvas, const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c,
                   std::int32_t item, const std::optional<ScreenClip>& clip) {
  const double area = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
  if (!std::isfinite(area) || area == 0.0) return;
  const int left = std::max(0, first_pixel(std::min({a.u, b.u, c.u})));
  const int right = std::min(canvas.width - 1, last_pixel(std::max({a.u, b.u, c.u})));
  const int top = std::max(0, first_pixel(std::min({a.v, b.v, c.v})));
  const int bottom = std::min(canvas.height - 1, last_pixel(std::max({a.v, b.v, c.v})));
  for (int y = top; y <= bottom; ++y) {
    const double v = centre_of(y);
    for (int x = left; x <= right; ++x) {
      const double u = centre_of(x);
      const double of_a = ((b.u - u) * (c.v - v) - (b.v - v) * (c.u - u)) / area;
      const double of_b = ((c.u - u) * (a.v - v) - (c.v - v) * (a.u - u)) / area;
      const double of_c = 1.0 - of_a - of_b;
      if (of_a < 0.0 || of_b < 0.0 || of_c < 0.0) continue;
      const double depth = of_a * a.depth + of_b * b.depth + of_c * c.depth;
      if (clip && clip->beyond(u, v, depth) > 0.0) continue;
      put(canvas, x, y, depth, item);
    }
  }
}

}  // namespace breccia
