#include "report/breakage.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "math/constants.hpp"

namespace breccia::report {
namespace {

constexpr double degrees = 180.0 / pi;

void count(Rose& rose, double angle, double weight) {
  const double share = (angle - rose.from) / (rose.to - rose.from);
  const auto bars = static_cast<double>(rose.bars.size());
  const double bar = std::clamp(std::floor(share * bars), 0.0, bars - 1.0);
  rose.bars[static_cast<std::size_t>(bar)] += weight;
}

/// The angle of a line without direction, 0 to 180.  [deg]
double line_angle(double x, double y) {
  const double angle = degrees * std::atan2(y, x);
  return angle < 0.0 ? angle + 180.0 : angle >= 180.0 ? angle - 180.0 : angle;
}

std::vector<Rose> roses_in_plane(const NumberTable& cracks) {
  const Column *x0 = cracks.column("x0"), *y0 = cracks.column("y0");
  const Column *x1 = cracks.column("x1"), *y1 = cracks.column("y1");
  if (x0 == nullptr || y0 == nullptr || x1 == nullptr || y1 == nullptr || cracks.rows() == 0)
    return {};
  Rose rose{"direction of cracks, from x", 0.0, 180.0, "m", std::vector<double>(18, 0.0)};
  for (std::size_t i = 0; i < cracks.rows(); ++i) {
    const double dx = x1->values[i] - x0->values[i], dy = y1->values[i] - y0->values[i];
    if (dx != 0.0 || dy != 0.0) count(rose, line_angle(dx, dy), std::hypot(dx, dy));
  }
  return {rose};
}

/// Area and normal of what broke: of a face of tetrahedra, or of spheres a disc across the link.
struct CrackPlane {
  Vec3 normal;  ///< of any length; 0: none
  double area;  ///<  [m2]
};
CrackPlane plane_of(const Shot& first, const Shot& last, std::size_t line) {
  if (last.solid) {
    const Vec3* const p = &last.end[3 * line];
    const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
    return {normal, 0.5 * norm(normal)};
  }
  const std::size_t a = at(last.ends[2 * line]), b = at(last.ends[2 * line + 1]);
  const double r = std::min(first.radius[a], first.radius[b]);
  return {first.corner[b] - first.corner[a], pi * r * r};
}

std::vector<Rose> roses_in_space(const Shot& first, const Shot& last) {
  const std::vector<std::uint8_t> broken = broken_lines(last);
  Rose strike{"strike of steep crack planes, from x", 0.0, 180.0, "m2",
              std::vector<double>(18, 0.0)};
  Rose dip{"dip of crack planes: 0 flat, 90 upright", 0.0, 90.0, "m2", std::vector<double>(9, 0.0)};
  bool any = false;
  for (std::size_t l = 0; l < broken.size(); ++l) {
    if (broken[l] == 0) continue;
    const auto [axis, area] = plane_of(first, last, l);
    const double length = norm(axis);
    if (!(length > 0.0)) continue;
    any = true;
    const double tilt = degrees * std::acos(std::min(1.0, std::abs(axis.z) / length));
    count(dip, tilt, area);
    if (tilt > 30.0) count(strike, line_angle(-axis.y, axis.x), area);
  }
  if (!any) return {};
  return {strike, dip};
}

}  // namespace

std::vector<Rose> roses_of(const Record& record, const Shot& first, const Shot& last) {
  return last.plane ? roses_in_plane(record.cracks) : roses_in_space(first, last);
}

std::vector<double> fragment_shares(const Record& record, const Shot& last) {
  std::vector<double> shares;
  if (const Column* const mass = record.fragments.column("mass")) {
    shares = mass->values;
  } else if (last.spheres() && !last.ends.empty()) {
    std::vector<std::size_t> root(last.elements());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    const std::vector<std::uint8_t> broken = broken_lines(last);
    for (std::size_t l = 0; l < broken.size(); ++l)
      if (broken[l] == 0) root[find(at(last.ends[2 * l]))] = find(at(last.ends[2 * l + 1]));
    std::vector<double> volume(last.elements(), 0.0);
    for (std::size_t i = 0; i < volume.size(); ++i)
      volume[find(i)] += last.radius[i] * last.radius[i] * last.radius[i];
    for (const double v : volume)
      if (v > 0.0) shares.push_back(v);
  }
  std::sort(shares.begin(), shares.end(), std::greater<>());
  const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= all > 0.0 ? all : 1.0;
  return shares;
}

}  // namespace breccia::report
