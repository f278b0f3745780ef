#include "app/camera_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "exec/error.hpp"
#include "io/case/case_file.hpp"
#include "io/picture/camera.hpp"

namespace breccia::app {
namespace {

Vec3 mixed(const Vec3& a, const Vec3& b, double share) {
  return (1.0 - share) * a + share * b;
}

Vec3 unit(const Vec3& v) {
  return (1.0 / norm(v)) * v;
}

/// The way from one direction to another along the sphere.
Vec3 turned_towards(const Vec3& a, const Vec3& b, double share) {
  const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0));
  if (angle < 1e-6 || angle > std::numbers::pi - 1e-6) return unit(mixed(a, b, share) + 1e-9 * a);
  return (1.0 / std::sin(angle)) *
         (std::sin((1.0 - share) * angle) * a + std::sin(share * angle) * b);
}

/// Rodrigues' rotation about a unit axis.
Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) +
         (1.0 - std::cos(angle)) * dot(axis, v) * axis;
}

/// Axis and side of a plane such as "x<0.1", and its place.
struct Plane {
  std::string side;
  double place = 0.0;
};
std::optional<Plane> plane_of(const std::string& text) {
  const std::size_t sign = text.find_first_of("<>=");
  if (sign == std::string::npos) return {};
  Plane plane{text.substr(0, sign + 1), 0.0};
  const char* begin = text.data() + sign + 1;
  while (*begin == ' ') ++begin;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, plane.place);
  if (error != std::errc{} || stop != end) return {};
  return plane;
}

std::string clip_between(const std::string& a, const std::string& b, double share) {
  const auto from = plane_of(a), to = plane_of(b);
  if (!from || !to || from->side != to->side) return share < 1.0 ? a : b;
  return fmt::format("{}{}", from->side, (1.0 - share) * from->place + share * to->place);
}

}  // namespace

CameraPath::CameraPath(const std::string& path) {
  if (!std::filesystem::exists(path))
    throw InputError(path + ": there is no such camera file; nothing was drawn.");
  file_ = read_case<CameraFile>(path, {});
  const auto refuse = [&](const std::string& why) {
    throw InputError(with_lines("1 problem; nothing was drawn.\n  " + why, path));
  };
  if (file_.keys.empty() && file_.turntable.turns == 0.0)
    refuse("a camera needs a [[key]] or a [turntable] with turns");
  if (!(norm(file_.turntable.axis) > 0.0)) refuse("turntable.axis has no direction");
  for (std::size_t k = 0; k < file_.keys.size(); ++k) {
    const CameraKey& key = file_.keys[k];
    const std::string name = fmt::format("key[{}]", k + 1);
    if (k > 0 && !(key.time > file_.keys[k - 1].time))
      refuse(
          fmt::format("{}.time = {} s is not later than that of the key before", name, key.time));
    if (!(norm(key.eye - key.target) > 0.0)) refuse(name + ".eye is where its target is");
    if (!(norm(cross(key.up, key.eye - key.target)) > 0.0))
      refuse(name + ".up points along the line of sight");
    if (!key.clip.empty()) clip_of(key.clip, axes_of_view("iso"));
  }
}

void CameraPath::set_from_keys(RenderOptions& options, double time) const {
  const std::vector<CameraKey>& keys = file_.keys;
  std::size_t next = 0;
  while (next < keys.size() && keys[next].time <= time) ++next;
  const CameraKey& a = keys[next == 0 ? 0 : next - 1];
  const CameraKey& b = keys[std::min(next, keys.size() - 1)];
  const double share = b.time > a.time ? (time - a.time) / (b.time - a.time) : 0.0;
  const Vec3 target = mixed(a.target, b.target, share);
  const Vec3 from = a.eye - a.target, to = b.eye - b.target;
  const double distance = std::pow(norm(from), 1.0 - share) * std::pow(norm(to), share);
  options.camera = Viewpoint{target + distance * turned_towards(unit(from), unit(to), share),
                             target, mixed(unit(a.up), unit(b.up), share),
                             std::pow(a.angle, 1.0 - share) * std::pow(b.angle, share)};
  if (!a.clip.empty() || !b.clip.empty()) options.clip = clip_between(a.clip, b.clip, share);
}

void CameraPath::apply(RenderOptions& options, double time, double share) const {
  if (!file_.keys.empty()) {
    set_from_keys(options, time);
  } else if (options.extent) {
    // A sphere around the extent fits from all sides.
    const Vec3 middle = 0.5 * (options.extent->low + options.extent->high);
    const double reach = norm(options.extent->high - options.extent->low);
    const Axes axes = axes_of_view(options.view);
    constexpr double distance = 2.0;  // in diameters of that sphere
    options.camera = Viewpoint{middle + distance * reach * axes.toward, middle, axes.up,
                               2.0 * std::atan(0.5 / distance)};
  }
  if (!options.camera || file_.turntable.turns == 0.0) return;
  Viewpoint& camera = *options.camera;
  const Vec3 axis = unit(file_.turntable.axis);
  const double angle = 2.0 * std::numbers::pi * file_.turntable.turns * share;
  camera.eye = camera.target + turned(camera.eye - camera.target, axis, angle);
  camera.up = turned(camera.up, axis, angle);
}

}  // namespace breccia::app
