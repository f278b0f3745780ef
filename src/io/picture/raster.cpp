#include "io/picture/raster.hpp"

#include <algorithm>
#include <cmath>

#include "exec/tasks.hpp"

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
  if (x < 0 || x >= canvas.width) return;
  const std::size_t place = canvas.row(y) + static_cast<std::size_t>(x);
  if (static_cast<float>(depth) <= canvas.depth[place]) return;
  canvas.depth[place] = static_cast<float>(depth);
  canvas.item[place] = item;
}

/// One row of a whole sphere, in whole blocks: pixels off the sphere never show.
void draw_row(float* depth, std::int32_t* item, int first, int last, const ScreenSphere& sphere,
              float half_chord_squared, std::int32_t number) {
  const int start = first / Canvas::block * Canvas::block;
  const int end = (last / Canvas::block + 1) * Canvas::block;
  const float centre = sphere.u - 0.5F, middle = sphere.depth;
  for (int x = start; x < end; ++x) {
    const float offset = static_cast<float>(x) - centre;
    const float height_squared = half_chord_squared - offset * offset;
    const float off = height_squared < 0.0F ? Canvas::empty : 0.0F;
    const float surface = middle + std::sqrt(std::max(0.0F, height_squared)) + off;
    const float before = depth[x];
    const std::int32_t wins = surface > before ? -1 : 0;  // a mask: branches would stop the lanes
    item[x] = (number & wins) | (item[x] & ~wins);
    depth[x] = std::max(before, surface);
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

/// A sphere that can be seen, and the pixels it may cover.
struct Visible {
  std::int32_t item;
  float front;   ///< depth of its nearest point
  bool crossed;  ///< by the clip plane
  int left, right, top, bottom;
};

std::optional<Visible> visible(const Canvas& canvas, const ScreenSphere& sphere, std::int32_t item,
                               const std::optional<ScreenClip>& clip) {
  const auto [u, v, depth, r] = sphere;
  if (!(r > 0.0F) || !(std::fabs(depth) < 1e20F)) return std::nullopt;
  Visible box{item, depth + r, false, 0, 0, 0, 0};
  box.left = std::max(0, first_pixel(u - r));
  box.right = std::min(canvas.width - 1, last_pixel(u + r));
  box.top = std::max(0, first_pixel(v - r));
  box.bottom = std::min(canvas.height - 1, last_pixel(v + r));
  if (!(u == u && v == v) || box.left > box.right || box.top > box.bottom) return std::nullopt;
  if (clip) {
    const double beyond = clip->beyond(u, v, depth);
    if (beyond >= r) return std::nullopt;
    box.crossed = beyond > -r;
  }
  return box;
}

/// A rectangle of pixels small enough to stay in the fastest cache.
struct Tile {
  static constexpr int width = 64, height = 32;  // pixels; width is a multiple of Canvas::block
  int left, right, top, bottom;                  ///< the last ones included
};

/// Whether no pixel of a tile is farther than `front`: nothing behind it can show.
bool is_filled(const Canvas& canvas, const Tile& tile, float front) {
  for (int y = tile.top; y <= tile.bottom; ++y) {
    const float* const depth = &canvas.depth[canvas.row(y)];
    int farther = 0;
    for (int x = tile.left; x <= tile.right; ++x) farther |= depth[x] < front ? 1 : 0;
    if (farther != 0) return false;
  }
  return true;
}

void draw_in_tile(Canvas& canvas, const Tile& tile, const ScreenSphere& sphere, const Visible& seen,
                  const std::optional<ScreenClip>& clip) {
  const int bottom = std::min(tile.bottom, seen.bottom);
  for (int y = std::max(tile.top, seen.top); y <= bottom; ++y) {
    const float dv = static_cast<float>(y) + 0.5F - sphere.v;
    const float half_chord_squared = sphere.radius * sphere.radius - dv * dv;
    if (half_chord_squared <= 0.0F) continue;
    const float half_chord = std::sqrt(half_chord_squared);
    const int first = std::max(tile.left, first_pixel(sphere.u - half_chord));
    const int last = std::min(tile.right, last_pixel(sphere.u + half_chord));
    if (first > last) continue;
    if (seen.crossed) {
      draw_cut_row(canvas, y, first, last, sphere, half_chord_squared, seen.item, *clip);
    } else {
      draw_row(&canvas.depth[canvas.row(y)], &canvas.item[canvas.row(y)], first, last, sphere,
               half_chord_squared, seen.item);
    }
  }
}

/// Walks along a line: visit(point, along, first, steep). Pixels across it begin with `first`, in
/// the row `along` of a steep line, in the column `along` of another.
template <class Visit>
void walk_line(const Canvas& canvas, const ScreenPoint& a, const ScreenPoint& b, int thickness,
               const Visit& visit) {
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
    const double across = (steep ? u : v) - 0.5 * thickness;
    const int first = static_cast<int>(std::floor(across + 0.5));
    const int along = static_cast<int>(std::floor(steep ? v : u));
    visit(ScreenPoint{u, v, depth}, along, first, steep);
  }
}

}  // namespace

Canvas::Canvas(int wide, int high)
    : width(wide), height(high), stride((wide + block - 1) / block * block) {
  const std::size_t size = row(high);
  depth.assign(size, empty);
  item.assign(size, none);
}

void draw_spheres(Canvas& canvas, std::span<const ScreenSphere> spheres,
                  const std::optional<ScreenClip>& clip, int threads) {
  std::vector<Visible> order;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const auto item = static_cast<std::int32_t>(i);
    if (const auto seen = visible(canvas, spheres[i], item, clip)) order.push_back(*seen);
  }
  std::sort(order.begin(), order.end(), [](const Visible& a, const Visible& b) {
    return a.front != b.front ? a.front > b.front : a.item < b.item;
  });
  // Spheres by tile, in that order: count, sum, fill.
  const int across = (canvas.width + Tile::width - 1) / Tile::width;
  const int down = (canvas.height + Tile::height - 1) / Tile::height;
  std::vector<std::size_t> start(static_cast<std::size_t>(across * down) + 1, 0);
  const auto each_tile = [across](const Visible& seen, auto&& visit) {
    for (int y = seen.top / Tile::height; y <= seen.bottom / Tile::height; ++y) {
      for (int x = seen.left / Tile::width; x <= seen.right / Tile::width; ++x) {
        visit(static_cast<std::size_t>(y * across + x));
      }
    }
  };
  for (const Visible& seen : order) each_tile(seen, [&](std::size_t tile) { ++start[tile + 1]; });
  for (std::size_t tile = 1; tile < start.size(); ++tile) start[tile] += start[tile - 1];
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  std::vector<std::uint32_t> in_tile(start.back());
  for (std::size_t i = 0; i < order.size(); ++i) {
    each_tile(order[i],
              [&](std::size_t tile) { in_tile[next[tile]++] = static_cast<std::uint32_t>(i); });
  }
  for_each_task(threads, across * down, [&](int number_of_tile) {
    const auto number = static_cast<std::size_t>(number_of_tile);
    const int left = number_of_tile % across * Tile::width;
    const int top = number_of_tile / across * Tile::height;
    const Tile tile{left, std::min(left + Tile::width, canvas.width) - 1, top,
                    std::min(top + Tile::height, canvas.height) - 1};
    for (std::size_t k = start[number]; k < start[number + 1]; ++k) {
      const Visible& seen = order[in_tile[k]];
      const bool look = (k - start[number]) % 4 == 0;
      if (look && is_filled(canvas, tile, seen.front)) break;
      draw_in_tile(canvas, tile, spheres[static_cast<std::size_t>(seen.item)], seen, clip);
    }
  });
}

void draw_line(Canvas& canvas, Rows rows, const ScreenPoint& a, const ScreenPoint& b, int thickness,
               std::int32_t item, const std::optional<ScreenClip>& clip) {
  walk_line(canvas, a, b, thickness, [&](const ScreenPoint& at, int along, int first, bool steep) {
    if (clip && clip->beyond(at.u, at.v, at.depth) > 0.0) return;
    for (int k = first; k < first + thickness; ++k) {
      const int y = steep ? along : k;
      if (y >= rows.top && y <= rows.bottom) put(canvas, steep ? k : along, y, at.depth, item);
    }
  });
}

void draw_mark(Canvas& canvas, Rows rows, const ScreenPoint& a, const ScreenPoint& b, int thickness,
               std::int32_t item, const std::optional<ScreenClip>& clip) {
  // The sides of a crack have moved: one may stand a little before the mark, or gape beneath it.
  constexpr double before_mark = 0.01, beneath_mark = 0.12;  // of its length
  const double du = b.u - a.u, dv = b.v - a.v, dd = b.depth - a.depth;
  const double length = std::sqrt(du * du + dv * dv + dd * dd);
  const double lift = 3.0 + before_mark * length, behind = 3.0 + beneath_mark * length;  // pixels
  const auto depth_at = [&canvas](int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < canvas.width && y < canvas.height;
    return inside ? static_cast<double>(canvas.depth[canvas.row(y) + static_cast<std::size_t>(x)])
                  : 1.0 * Canvas::empty;
  };
  walk_line(canvas, a, b, thickness, [&](const ScreenPoint& at, int along, int first, bool steep) {
    if (clip && clip->beyond(at.u, at.v, at.depth) > 1.0) return;
    bool on_surface = false;  // of either side
    for (int k = first; k < first + thickness; ++k) {
      const double there = depth_at(steep ? k : along, steep ? along : k);
      on_surface = on_surface || (there <= at.depth + lift && there >= at.depth - behind);
    }
    if (!on_surface) return;
    for (int k = first; k < first + thickness; ++k) {
      const int x = steep ? k : along, y = steep ? along : k;
      const double there = depth_at(x, y), slack = lift + thickness;
      if (y < rows.top || y > rows.bottom || there > at.depth + slack ||
          there < at.depth - behind - slack)
        continue;
      canvas.item[canvas.row(y) + static_cast<std::size_t>(x)] = item;
    }
  });
}

void draw_triangle(Canvas& canvas, Rows rows, const ScreenPoint& a, const ScreenPoint& b,
                   const ScreenPoint& c, std::int32_t item, const std::optional<ScreenClip>& clip) {
  constexpr double edge = 1e-9;  // neighbours share their border: no pixel on it stays empty
  const double area = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
  if (!std::isfinite(area) || area == 0.0) return;
  const int left = std::max(0, first_pixel(std::min({a.u, b.u, c.u})));
  const int right = std::min(canvas.width - 1, last_pixel(std::max({a.u, b.u, c.u})));
  const int top = std::max(rows.top, first_pixel(std::min({a.v, b.v, c.v})));
  const int bottom = std::min(rows.bottom, last_pixel(std::max({a.v, b.v, c.v})));
  for (int y = top; y <= bottom; ++y) {
    const double v = centre_of(y);
    for (int x = left; x <= right; ++x) {
      const double u = centre_of(x);
      const double of_a = ((b.u - u) * (c.v - v) - (b.v - v) * (c.u - u)) / area;
      const double of_b = ((c.u - u) * (a.v - v) - (c.v - v) * (a.u - u)) / area;
      const double of_c = 1.0 - of_a - of_b;
      if (of_a < -edge || of_b < -edge || of_c < -edge) continue;
      const double depth = of_a * a.depth + of_b * b.depth + of_c * c.depth;
      if (clip && clip->beyond(u, v, depth) > 0.0) continue;
      put(canvas, x, y, depth, item);
    }
  }
}

}  // namespace breccia
