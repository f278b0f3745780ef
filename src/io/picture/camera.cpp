#include "io/picture/camera.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

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

}  // namespace

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

Camera camera_at(const Viewpoint& from, const Window& window) {
  const Vec3 way = from.eye - from.target;
  const double distance = norm(way);
  const Vec3 sideways = cross(from.up, way);
  const bool good = distance > 0.0 && norm(sideways) > 1e-9 * distance * norm(from.up) &&
                    from.field_of_view > 0.0 && from.field_of_view < 3.1;
  if (!good)
    throw InputError(
        "a camera needs an eye away from its target, an upward direction that is not along its "
        "line of sight, and an angle between 0 and 178 degrees");
  const Vec3 toward = (1.0 / distance) * way, right = (1.0 / norm(sideways)) * sideways;
  const double high = 2.0 * distance * std::tan(0.5 * from.field_of_view);
  return {{right, cross(toward, right), toward},
          from.target,
          0.5 * (window.left + window.right),
          0.5 * (window.top + window.bottom),
          (window.bottom - window.top) / high};
}

Extent cut_extent(const Extent& extent, const Clip& clip) {
  Extent cut = extent;
  const auto limit = [&](double normal, double& low, double& high) {
    if (normal > 0.5) high = std::max(low, std::min(high, clip.offset));
    if (normal < -0.5) low = std::min(high, std::max(low, -clip.offset));
  };
  limit(clip.normal.x, cut.low.x, cut.high.x);
  limit(clip.normal.y, cut.low.y, cut.high.y);
  limit(clip.normal.z, cut.low.z, cut.high.z);
  cut.outline_points = 0;
  return cut;
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
