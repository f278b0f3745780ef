#include "io/picture/scene.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "io/frame_pair.hpp"

namespace breccia {

void place_spheres(Canvas& canvas, const Frame& frame, double share, Scene& scene, int threads) {
  constexpr double smallest = 0.75;  // pixels: nothing that flies about is lost
  std::vector<ScreenSphere> spheres(frame.position.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const ScreenPoint point = scene.point(i);
    if (is_paired(frame) && !(frame.radius[i] > 0.0)) {  // a corner of a body: far off the canvas
      spheres[i] = {-1e9F, -1e9F, 0.0F, 0.0F};
      continue;
    }
    const double radius = std::max(smallest, share * scene.camera.resolution * frame.radius[i]);
    spheres[i] = {static_cast<float>(point.u), static_cast<float>(point.v),
                  static_cast<float>(point.depth), static_cast<float>(radius)};
    scene.looks[i].sphere = spheres[i];
  }
  draw_spheres(canvas, spheres, scene.clip, threads);
}

void draw_lines(Canvas& canvas, const Frame& frame, const Coloring& coloring, Scene& scene,
                int threads) {
  const std::vector<Color>& colors = coloring.lines;
  const double usual =
      std::max(coloring.cracks ? 3.0 : 2.0, canvas.width / (coloring.cracks ? 480.0 : 640.0));
  const auto thickness_of = [&](std::size_t line) {
    const double factor = coloring.line_widths.empty() ? 1.0 : coloring.line_widths[line];
    return std::max(1, static_cast<int>(factor * usual + 0.25));
  };
  const double lift = frame.triangles.empty() ? 0.0 : 2.0;  // lines on the edges of triangles show
  const Vec3 lamp = lamp_direction();
  const std::size_t first = scene.looks.size();
  Bands bands(canvas, threads);
  const auto ends = [&](std::size_t line) {
    ScreenPoint a = scene.point(static_cast<std::size_t>(frame.lines[2 * line]));
    ScreenPoint b = scene.point(static_cast<std::size_t>(frame.lines[2 * line + 1]));
    a.depth += lift;
    b.depth += lift;
    return std::pair{a, b};
  };
  for (std::size_t line = 0; line < colors.size(); ++line) {
    scene.looks.push_back({});
    if (!coloring.hidden_lines.empty() && coloring.hidden_lines[line]) continue;
    const auto [a, b] = ends(line);
    // A thin cylinder is as bright as its steepest side towards the lamp.
    const Vec3 axis{b.u - a.u, a.v - b.v, b.depth - a.depth};
    const double along = dot(axis, lamp), square = dot(axis, axis);
    const double across = square > 0.0 ? std::max(0.0, 1.0 - along * along / square) : 1.0;
    const auto light = static_cast<float>(0.55 + 0.45 * std::sqrt(across));
    scene.looks.back().color = shaded(colors[line], light);
    bands.add(line, std::min(a.v, b.v), std::max(a.v, b.v), thickness_of(line) + 1.0);
  }
  bands.draw([&](std::size_t line, Rows rows) {
    const auto [a, b] = ends(line);
    const auto item = static_cast<std::int32_t>(first + line);
    draw_line(canvas, rows, a, b, thickness_of(line), item, scene.clip);
  });
}

void draw_triangles(Canvas& canvas, const Frame& frame, const std::vector<Color>& colors,
                    Scene& scene, int threads) {
  const Vec3 lamp = lamp_direction();
  const std::size_t first = scene.looks.size();
  Bands bands(canvas, threads);
  const auto corners = [&](std::size_t triangle) {
    const auto corner = [&](std::size_t k) {
      return scene.point(static_cast<std::size_t>(frame.triangles[3 * triangle + k]));
    };
    return std::array{corner(0), corner(1), corner(2)};
  };
  scene.looks.resize(first + colors.size());
  for_chunks(threads, colors.size(), [&](std::size_t triangle) {
    const auto [a, b, c] = corners(triangle);
    const Vec3 normal = cross(Vec3{b.u - a.u, a.v - b.v, b.depth - a.depth},
                              Vec3{c.u - a.u, a.v - c.v, c.depth - a.depth});
    const double size = norm(normal);
    const double facing = size > 0.0 ? std::fabs(dot(normal, lamp)) / size / lamp.z : 1.0;
    const auto light = static_cast<float>(0.5 + 0.5 * std::min(1.0, facing));
    scene.looks[first + triangle].color = shaded(colors[triangle], light);
  });
  for (std::size_t triangle = 0; triangle < colors.size(); ++triangle) {
    const auto [a, b, c] = corners(triangle);
    bands.add(triangle, std::min({a.v, b.v, c.v}), std::max({a.v, b.v, c.v}), 1.0);
  }
  bands.draw([&](std::size_t triangle, Rows rows) {
    const auto [a, b, c] = corners(triangle);
    const auto item = static_cast<std::int32_t>(first + triangle);
    draw_triangle(canvas, rows, a, b, c, item, scene.clip);
  });
}

}  // namespace breccia
