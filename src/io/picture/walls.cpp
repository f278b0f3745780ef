#include "io/picture/walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/picture/pixel.hpp"
#include "io/round_numbers.hpp"

namespace breccia {
namespace {

constexpr Color steel{0.48F, 0.55F, 0.64F};
constexpr double edge_on = 0.02;  ///< cosine of the angle from which a wall is an edge

/// The rectangle of a wall that lies about an extent.
struct Patch {
  Vec3 corner, a, b;  ///< two sides from a corner  [m]
  double length_a, length_b;
};

Patch patch_of(const FrameWall& wall, const Extent& extent) {
  const Vec3& n = wall.normal;
  const Vec3 along = std::fabs(n.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 first = along - dot(along, n) * n;
  const Vec3 a = (1.0 / norm(first)) * first, b = cross(n, a);
  std::array<double, 2> low{1e300, 1e300}, high{-1e300, -1e300};
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner{(k & 1) != 0 ? extent.high.x : extent.low.x,
                      (k & 2) != 0 ? extent.high.y : extent.low.y,
                      (k & 4) != 0 ? extent.high.z : extent.low.z};
    const Vec3 way = corner - wall.point;
    for (const auto& [place, axis] : {std::pair{0U, a}, std::pair{1U, b}}) {
      low[place] = std::min(low[place], dot(way, axis));
      high[place] = std::max(high[place], dot(way, axis));
    }
  }
  const double margin = 0.03 * norm(extent.high - extent.low);
  for (double& x : low) x -= margin;
  for (double& x : high) x += margin;
  const double length_a = high[0] - low[0], length_b = high[1] - low[1];
  return {wall.point + low[0] * a + low[1] * b, length_a * a, length_b * b, length_a, length_b};
}

/// Where pixels of the canvas lie on a patch: shares of its sides, and the depth there.
struct OnPatch {
  ScreenPoint corner;
  double a_u, a_v, a_d, b_u, b_v, b_d, area;

  OnPatch(const Patch& patch, const Camera& camera) : corner(camera.project(patch.corner)) {
    const ScreenPoint a = camera.project(patch.corner + patch.a),
                      b = camera.project(patch.corner + patch.b);
    a_u = a.u - corner.u, a_v = a.v - corner.v, a_d = a.depth - corner.depth;
    b_u = b.u - corner.u, b_v = b.v - corner.v, b_d = b.depth - corner.depth;
    area = a_u * b_v - a_v * b_u;
  }
  double share_a(double u, double v) const {
    return ((u - corner.u) * b_v - (v - corner.v) * b_u) / area;
  }
  double share_b(double u, double v) const {
    return ((v - corner.v) * a_u - (u - corner.u) * a_v) / area;
  }
};

bool is_edge(const FrameWall& wall, const Camera& camera) {
  return std::fabs(dot(wall.normal, camera.axes.toward)) < edge_on;
}

void draw_wall(Image& image, const FrameWall& wall, const Canvas& canvas, const Scene& scene,
               const Extent& extent, int fine, int scale) {
  const Patch patch = patch_of(wall, extent);
  const OnPatch on(patch, scene.camera);
  const double mesh = round_step_below(0.15 * norm(extent.high - extent.low));
  const double line = 0.6 * scale * fine / scene.camera.resolution;  // half the width  [m]
  const int samples = std::max(2, fine);
  const double step = 1.0 * fine / samples;
  const auto is_line = [&](double place, double length) {
    const double off = std::fabs(place / mesh - std::round(place / mesh)) * mesh;
    return std::min({off, place, length - place}) < line;
  };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      double share = 0.0;
      for (int k = 0; k < samples * samples; ++k) {
        const double u = fine * x + (k % samples + 0.5) * step;
        const double v = fine * y + (k / samples + 0.5) * step;
        const double a = on.share_a(u, v), b = on.share_b(u, v);
        if (a < 0.0 || a > 1.0 || b < 0.0 || b > 1.0) continue;
        const double depth = on.corner.depth + a * on.a_d + b * on.b_d;
        if (scene.clip && scene.clip->beyond(u, v, depth) > 0.0) continue;
        const std::size_t at =
            canvas.row(static_cast<int>(v)) + static_cast<std::size_t>(static_cast<int>(u));
        if (canvas.depth[at] >= depth) continue;
        const bool before_model = canvas.item[at] != Canvas::none;
        const bool grid = is_line(a * patch.length_a, patch.length_a) ||
                          is_line(b * patch.length_b, patch.length_b);
        share += before_model ? (grid ? 0.30 : 0.08) : (grid ? 0.55 : 0.22);
      }
      if (share > 0.0)
        mix_pixel(image, x, y, steel, static_cast<float>(share / (samples * samples)));
    }
}

/// A triangle of a wall that ends, without a grid.
void draw_triangle(Image& image, const Patch& half, const Canvas& canvas, const Scene& scene,
                   int fine) {
  const OnPatch on(half, scene.camera);
  if (!(std::fabs(on.area) > 0.0)) return;  // seen from its edge
  const auto pixels = [fine](double corner, double a, double b, int end) {
    const double low = corner + std::min({0.0, a, b}), high = corner + std::max({0.0, a, b});
    return std::pair{static_cast<int>(std::clamp(std::floor(low / fine), 0.0, 1.0 * end)),
                     static_cast<int>(std::clamp(std::ceil(high / fine), 0.0, 1.0 * end))};
  };
  const auto [left, right] = pixels(on.corner.u, on.a_u, on.b_u, image.width);
  const auto [top, bottom] = pixels(on.corner.v, on.a_v, on.b_v, image.height);
  constexpr int samples = 2;
  const double step = 1.0 * fine / samples;
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      double share = 0.0;
      for (int k = 0; k < samples * samples; ++k) {
        const double u = fine * x + (k % samples + 0.5) * step;
        const double v = fine * y + (k / samples + 0.5) * step;
        const double a = on.share_a(u, v), b = on.share_b(u, v);
        if (a < 0.0 || b < 0.0 || a + b > 1.0) continue;
        const double depth = on.corner.depth + a * on.a_d + b * on.b_d;
        if (scene.clip && scene.clip->beyond(u, v, depth) > 0.0) continue;
        const std::size_t at =
            canvas.row(static_cast<int>(v)) + static_cast<std::size_t>(static_cast<int>(u));
        if (canvas.depth[at] >= depth) continue;
        share += canvas.item[at] != Canvas::none ? 0.08 : 0.20;
      }
      if (share > 0.0)
        mix_pixel(image, x, y, steel, static_cast<float>(share / (samples * samples)));
    }
}

}  // namespace

void draw_walls(Image& image, const std::vector<FrameWall>& walls, const Canvas& canvas,
                const Scene& scene, const Extent& extent, int fine, int scale) {
  for (const FrameWall& wall : walls) {
    for (std::size_t k = 0; k + 2 < wall.corners.size(); k += 3)
      draw_triangle(image,
                    {wall.corners[k], wall.corners[k + 1] - wall.corners[k],
                     wall.corners[k + 2] - wall.corners[k], 1.0, 1.0},
                    canvas, scene, fine);
    if (wall.corners.empty() && !is_edge(wall, scene.camera))
      draw_wall(image, wall, canvas, scene, extent, fine, scale);
  }
}

void draw_wall_edges(Paper& paper, const std::vector<FrameWall>& walls, const Camera& camera,
                     const Extent& extent, int scale) {
  for (const FrameWall& wall : walls) {
    if (!wall.corners.empty() || !is_edge(wall, camera)) continue;
    const Patch patch = patch_of(wall, extent);
    const ScreenPoint corner = camera.project(patch.corner);
    const ScreenPoint a = camera.project(patch.corner + patch.a),
                      b = camera.project(patch.corner + patch.b);
    const auto long_side = [&](const ScreenPoint& p) {
      return std::hypot(p.u - corner.u, p.v - corner.v);
    };
    const ScreenPoint end = long_side(a) > long_side(b) ? a : b;
    const double length = long_side(end);
    if (!(length > 1.0) || !(length < 1e5)) continue;
    const double solid_u = -dot(wall.normal, camera.axes.right),
                 solid_v = dot(wall.normal, camera.axes.up);
    const double along_u = (end.u - corner.u) / length, along_v = (end.v - corner.v) / length;
    const double tick = 5.0 * scale, gap = 6.0 * scale;
    for (double at = 0.5 * gap; at < length; at += gap) {
      const double u = corner.u + at * along_u, v = corner.v + at * along_v;
      if (u < 0.0 || v < 0.0 || u > paper.width || v > paper.height) continue;
      paper.stroke(u, v, u + tick * (solid_u - 0.7 * along_u), v + tick * (solid_v - 0.7 * along_v),
                   0.8 * scale, steel);
    }
    paper.stroke(corner.u, corner.v, end.u, end.v, 1.4 * scale, steel);
  }
}

}  // namespace breccia
