#include "io/picture/camera.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

#include "exec/error.hpp"

namespace breccia {
namespace {

/// How far an extent reaches on the picture, from the origin of space.  [m]
struct Reach {
  double left = 1e300, right = -1e300, bottom = 1e300, top = -1e300;

  void add(const Vec3& point, const Axes& axes) {
    const double u = dot(point, axes.right), v = dot(point, axes.up);
    left = std::min(left, u);
    right = std::max(right, u);
    bottom = std::min(bottom, v);
    top = std::max(top, v);
  }
};

Vec3 corner(const Extent& extent, int number) {
  return {(number & 1) != 0 ? extent.high.x : extent.low.x,
          (number & 2) != 0 ? extent.high.y : extent.low.y,
          (number & 4) != 0 ? extent.high.z : extent.low.z};
}

/// Of the spheres within the box, the farthest places in the four directions of the slanted view;
/// in those of the other views the box itself is as tight.
std::array<Vec3, 4> outline_of(const Frame& frame, const Extent& extent) {
  const Axes axes = axes_of_view("iso");
  const std::array directions{axes.right, -axes.right, axes.up, -axes.up};
  std::array<double, 4> reach{-1e300, -1e300, -1e300, -1e300};
  std::array<Vec3, 4> outline;
  outline.fill(0.5 * (extent.low + extent.high));
  for (std::size_t i = 0; i < frame.position.size(); ++i) {
    const Vec3& p = frame.position[i];
    const double r = i < frame.radius.size() ? frame.radius[i] : 0.0;
    const bool inside = p.x - r >= extent.low.x && p.x + r <= extent.high.x &&
                        p.y - r >= extent.low.y && p.y + r <= extent.high.y &&
                        p.z - r >= extent.low.z && p.z + r <= extent.high.z;
    if (!inside) continue;
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const double there = dot(p, directions[d]) + r;
      if (there <= reach[d]) continue;
      reach[d] = there;
      outline[d] = p + r * directions[d];
    }
  }
  return outline;
}

bool is_finite(const Vec3& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

/// Where one coordinate of the bulk lies: the middle 98 in 100 items and what is near them.
struct Span {
  double low, high;
};
Span bulk_span(std::vector<double> values) {
  constexpr double outside = 0.01;  // share on either side that may have flown off
  constexpr double near = 0.25;     // of the bulk's width: still counts as part of it
  const auto count = static_cast<double>(values.size() - 1);
  const auto first = static_cast<std::ptrdiff_t>(outside * count);
  const auto last = static_cast<std::ptrdiff_t>((1.0 - outside) * count + 0.999);
  std::nth_element(values.begin(), values.begin() + first, values.end());
  const double low = values[static_cast<std::size_t>(first)];
  std::nth_element(values.begin(), values.begin() + last, values.end());
  const double high = values[static_cast<std::size_t>(last)];
  return {low - near * (high - low), high + near * (high - low)};
}

/// The body of each item of a field "group", in whole numbers; nothing if there is none.
std::vector<std::size_t> groups_in(const std::vector<FrameField>& fields, std::size_t items) {
  std::vector<std::size_t> groups;
  for (const FrameField& field : fields) {
    if (field.name != "group" || field.components != 1 || field.values.size() != items) continue;
    for (const float value : field.values)
      groups.push_back(value >= 0.0F && value < 1e6F ? static_cast<std::size_t>(value) : 0);
    return groups;
  }
  return groups;
}

/// The points of each body; those of all triangles' corners, or all, where the frame tells of none.
std::vector<std::vector<std::size_t>> bodies_of(const Frame& frame) {
  std::vector<std::vector<std::size_t>> bodies;
  const auto add = [&bodies](std::size_t body, std::size_t point) {
    if (body >= bodies.size()) bodies.resize(body + 1);
    bodies[body].push_back(point);
  };
  const std::vector<std::size_t> of_triangle =
      groups_in(frame.triangle_fields, frame.triangles.size() / 3);
  for (std::size_t t = 0; t < of_triangle.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      add(of_triangle[t], static_cast<std::size_t>(frame.triangles[3 * t + k]));
  if (!bodies.empty()) return bodies;
  const std::vector<std::size_t> of_point = groups_in(frame.point_fields, frame.position.size());
  for (std::size_t i = 0; i < frame.position.size(); ++i)
    add(of_point.empty() ? 0 : of_point[i], i);
  return bodies;
}

/// Widens an extent by the bulk of a body. A body of few points is bulk as a whole.
void add_bulk(Extent& extent, const Frame& frame, const std::vector<std::size_t>& body) {
  std::vector<double> x, y, z;
  for (const std::size_t i : body) {
    const Vec3& point = frame.position[i];
    if (!is_finite(point)) continue;
    x.push_back(point.x);
    y.push_back(point.y);
    z.push_back(point.z);
  }
  if (x.empty()) return;
  const Span in_x = bulk_span(std::move(x)), in_y = bulk_span(std::move(y)),
             in_z = bulk_span(std::move(z));
  const auto widen = [&extent](const Vec3& low, const Vec3& high) {
    extent.low = {std::min(extent.low.x, low.x), std::min(extent.low.y, low.y),
                  std::min(extent.low.z, low.z)};
    extent.high = {std::max(extent.high.x, high.x), std::max(extent.high.y, high.y),
                   std::max(extent.high.z, high.z)};
  };
  bool any = false;
  for (const std::size_t i : body) {
    const Vec3& p = frame.position[i];
    const bool inside = p.x >= in_x.low && p.x <= in_x.high && p.y >= in_y.low &&
                        p.y <= in_y.high && p.z >= in_z.low && p.z <= in_z.high;
    if (!inside) continue;
    const double r = i < frame.radius.size() ? frame.radius[i] : 0.0;
    widen(p - Vec3{r, r, r}, p + Vec3{r, r, r});
    any = true;
  }
  if (!any) widen({in_x.low, in_y.low, in_z.low}, {in_x.high, in_y.high, in_z.high});
}

}  // namespace

Extent bulk_extent(const Frame& frame) {
  constexpr double far = std::numeric_limits<double>::infinity();
  Extent extent{{far, far, far}, {-far, -far, -far}};
  for (const std::vector<std::size_t>& body : bodies_of(frame)) add_bulk(extent, frame, body);
  if (extent.low.x > extent.high.x) return {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};
  extent.outline = outline_of(frame, extent);
  extent.outline_points = static_cast<std::int64_t>(extent.outline.size());
  return extent;
}

Axes axes_of_view(const std::string& view) {
  if (view == "x") return {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  if (view == "y") return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
  if (view == "z") return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (view != "iso") {
    throw InputError("view = \"" + view + "\" is not one of iso, x, y, z");
  }
  const Vec3 direction{0.5, -0.8, 0.58};  // 32 degrees above the horizon
  const Vec3 toward = (1.0 / norm(direction)) * direction;
  const Vec3 sideways = cross(Vec3{0, 0, 1}, toward);
  const Vec3 right = (1.0 / norm(sideways)) * sideways;
  return {right, cross(toward, right), toward};
}

Camera fitted_camera(const Axes& axes, const Extent& extent, const Window& window) {
  const bool along_axes = axes.toward.x == 0.0 || axes.toward.y == 0.0 || axes.toward.z == 0.0;
  Reach reach;
  if (along_axes || extent.outline_points == 0) {
    for (int number = 0; number < 8; ++number) reach.add(corner(extent, number), axes);
  } else {
    for (const Vec3& point : extent.outline) reach.add(point, axes);
  }
  const double width = reach.right - reach.left, height = reach.top - reach.bottom;
  constexpr double none = 1e30;
  const double by_width = width > 0.0 ? (window.right - window.left) / width : none;
  const double by_height = height > 0.0 ? (window.bottom - window.top) / height : none;
  const double resolution = std::min(by_width, by_height);
  const Vec3 centre = 0.5 * (reach.left + reach.right) * axes.right +
                      0.5 * (reach.bottom + reach.top) * axes.up +
                      0.5 * dot(extent.low + extent.high, axes.toward) * axes.toward;
  return {axes, centre, 0.5 * (window.left + window.right), 0.5 * (window.top + window.bottom),
          resolution < none ? resolution : 1.0};
}

std::optional<Clip> clip_of(const std::string& text, const Axes& axes) {
  std::string plane;
  for (const char c : text) {
    if (c != ' ') plane.push_back(c);
  }
  if (plane.empty()) return std::nullopt;
  double value = 0.0;
  bool good = plane.size() >= 3 && plane[0] >= 'x' && plane[0] <= 'z' &&
              (plane[1] == '=' || plane[1] == '<' || plane[1] == '>');
  if (good) {
    const char* end = plane.data() + plane.size();
    const auto [stop, error] = std::from_chars(plane.data() + 2, end, value);
    good = error == std::errc() && stop == end && std::isfinite(value);
  }
  if (!good) {
    throw InputError("clip = \"" + text +
                     "\" is not a plane; write an axis, one of = < > and a number in m, such as "
                     "\"x=0\" or \"z<0.05\"");
  }
  const Vec3 axis{plane[0] == 'x' ? 1.0 : 0.0, plane[0] == 'y' ? 1.0 : 0.0,
                  plane[0] == 'z' ? 1.0 : 0.0};
  const bool viewer_is_below = dot(axis, axes.toward) < -1e-9;
  const bool drop_below = plane[1] == '>' || (plane[1] == '=' && viewer_is_below);
  if (drop_below) return Clip{-axis, -value};
  return Clip{axis, value};
}

ScreenClip on_screen(const Clip& clip, const Camera& camera) {
  const double nu = dot(clip.normal, camera.axes.right);
  const double nv = -dot(clip.normal, camera.axes.up);
  const double at_centre = camera.resolution * (dot(clip.normal, camera.centre) - clip.offset);
  return {nu, nv, dot(clip.normal, camera.axes.toward), at_centre - nu * camera.u - nv * camera.v};
}

}  // namespace breccia
