// The part of space that pictures show.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "io/frame_pair.hpp"
#include "io/picture/camera.hpp"

namespace breccia {
namespace {

/// The four directions of the slanted view; in those of the other views a box is tight.
std::array<Vec3, 4> outline_directions() {
  const Axes axes = axes_of_view("iso");
  return {axes.right, -axes.right, axes.up, -axes.up};
}

/// Of the spheres within the box, the farthest places in these directions.
std::array<Vec3, 4> outline_of(const Frame& frame, const Extent& extent) {
  const std::array directions = outline_directions();
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
struct BulkSpan {
  double low, high;
};
BulkSpan bulk_span(std::vector<double> values) {
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

/// The points of each body; those of all triangles' or tetrahedra's corners, or all, where the
/// frame tells of none.
std::vector<std::vector<std::size_t>> bodies_of(const Frame& frame) {
  std::vector<std::vector<std::size_t>> bodies;
  const auto add = [&bodies](std::size_t body, std::size_t point) {
    if (body >= bodies.size()) bodies.resize(body + 1);
    bodies[body].push_back(point);
  };
  const auto add_corners = [&](const std::vector<std::int32_t>& corners, std::size_t each,
                               const std::vector<FrameField>& fields) {
    const std::vector<std::size_t> groups = groups_in(fields, corners.size() / each);
    for (std::size_t k = 0; k < each * groups.size(); ++k)
      add(groups[k / each], static_cast<std::size_t>(corners[k]));
  };
  add_corners(frame.tetrahedra, 4, frame.tetrahedron_fields);
  if (frame.tetrahedra.empty()) add_corners(frame.triangles, 3, frame.triangle_fields);
  if (!bodies.empty() && !is_paired(frame)) return bodies;
  const std::vector<std::size_t> of_point = groups_in(frame.point_fields, frame.position.size());
  for (std::size_t i = 0; i < frame.position.size(); ++i)
    if (bodies.empty() || !is_paired(frame) || frame.radius[i] > 0.0)
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
  const BulkSpan in_x = bulk_span(std::move(x)), in_y = bulk_span(std::move(y)),
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

/// A box that holds nothing yet.
Extent nothing() {
  constexpr double far = std::numeric_limits<double>::infinity();
  return {{far, far, far}, {-far, -far, -far}};
}

Extent with_outline(Extent extent, const Frame& frame) {
  extent.outline = outline_of(frame, extent);
  extent.outline_points = static_cast<std::int64_t>(extent.outline.size());
  return extent;
}

double size_of(const Extent& extent) {
  return norm(extent.high - extent.low);
}

/// Both, with `share` more where the other one is outside.
Extent joined(const Extent& extent, const Extent& other, double share) {
  Extent both = extent;
  const auto widen = [share](double& low, double& high, double to_low, double to_high) {
    if (to_low < low) low -= (1.0 + share) * (low - to_low);
    if (to_high > high) high += (1.0 + share) * (to_high - high);
  };
  widen(both.low.x, both.high.x, other.low.x, other.high.x);
  widen(both.low.y, both.high.y, other.low.y, other.high.y);
  widen(both.low.z, both.high.z, other.low.z, other.high.z);
  both.outline_points = std::min(extent.outline_points, other.outline_points);
  const std::array directions = outline_directions();
  for (std::size_t d = 0; d < static_cast<std::size_t>(both.outline_points); ++d) {
    const double farther = dot(other.outline[d] - extent.outline[d], directions[d]);
    if (farther > 0.0) both.outline[d] = other.outline[d] + share * farther * directions[d];
  }
  return both;
}

/// Whether an extent shows another but for `slack` of its size.
bool shows(const Extent& extent, const Extent& other, double slack) {
  const double over = slack * size_of(extent);
  if (extent.outline_points > other.outline_points) return false;
  const std::array directions = outline_directions();
  for (std::size_t d = 0; d < static_cast<std::size_t>(extent.outline_points); ++d)
    if (dot(other.outline[d] - extent.outline[d], directions[d]) > over) return false;
  return other.low.x >= extent.low.x - over && other.low.y >= extent.low.y - over &&
         other.low.z >= extent.low.z - over && other.high.x <= extent.high.x + over &&
         other.high.y <= extent.high.y + over && other.high.z <= extent.high.z + over;
}

}  // namespace

namespace {

/// An extent with those walls that end within a sixth of its size around it, as rollers and platens
/// do; longer ones, and those that are away, would make the model small.
Extent with_walls(const Extent& extent, const Frame& frame) {
  const double reach = size_of(extent) / 6.0;
  Extent all = extent;
  for (const FrameWall& wall : frame.walls) {
    Extent box = nothing();
    for (const Vec3& corner : wall.corners) {
      if (!is_finite(corner)) continue;
      box.low = {std::min(box.low.x, corner.x), std::min(box.low.y, corner.y),
                 std::min(box.low.z, corner.z)};
      box.high = {std::max(box.high.x, corner.x), std::max(box.high.y, corner.y),
                  std::max(box.high.z, corner.z)};
    }
    const bool ends_near = box.low.x <= box.high.x && box.low.x >= extent.low.x - reach &&
                           box.low.y >= extent.low.y - reach && box.low.z >= extent.low.z - reach &&
                           box.high.x <= extent.high.x + reach &&
                           box.high.y <= extent.high.y + reach &&
                           box.high.z <= extent.high.z + reach;
    if (ends_near) all = joined(all, box, 0.0);
  }
  return all;
}

}  // namespace

Extent bulk_extent(const Frame& frame) {
  Extent extent = nothing();
  for (const std::vector<std::size_t>& body : bodies_of(frame)) add_bulk(extent, frame, body);
  if (extent.low.x > extent.high.x) return {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};
  const Extent all = with_walls(extent, frame);
  const bool wider = norm(all.low - extent.low) + norm(all.high - extent.high) > 0.0;
  return wider ? all : with_outline(extent, frame);  // an outline is that of bodies alone
}

Extent grown_extent(const Extent& extent, const Extent& first, const Frame& frame, double share) {
  constexpr double farthest = 4.0, of_largest = 12.0;  // times the first extent
  // A film stands still for what its margin shows; what looks at a whole run can show all.
  const double slack = share > 0.0 ? 0.005 : 0.0;
  const Extent now = bulk_extent(frame);
  if (frame.position.empty() || shows(extent, now, slack)) return extent;
  const Extent all = joined(extent, now, share);
  if (size_of(all) <= farthest * size_of(first)) return all;
  const std::vector<std::vector<std::size_t>> bodies = bodies_of(frame);
  Extent largest = nothing();
  add_bulk(largest, frame,
           *std::max_element(bodies.begin(), bodies.end(),
                             [](const auto& a, const auto& b) { return a.size() < b.size(); }));
  largest = with_outline(largest, frame);
  if (shows(extent, largest, slack)) return extent;
  const Extent with_largest = joined(extent, largest, share);
  if (size_of(with_largest) <= of_largest * size_of(first)) return with_largest;
  return largest;
}

}  // namespace breccia
