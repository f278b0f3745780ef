#include "prepare/tetrahedra/crack_network.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace breccia::prepare {
namespace {

constexpr double least_angle_sine = 0.342;  ///< of 20 degrees
constexpr double on_it = 1e-9;              ///< what lies so near lies on it, over sizes  [-]

double to_segment(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const double square = dot(way, way);
  const double t = square > 0.0 ? std::clamp(dot(point - from, way) / square, 0.0, 1.0) : 0.0;
  return norm(point - from - t * way);
}

double between_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  double least = std::min(std::min(to_segment(a, c, d), to_segment(b, c, d)),
                          std::min(to_segment(c, a, b), to_segment(d, a, b)));
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = uu * vv - uv * uv;
  if (!(det > 1e-14 * uu * vv)) return least;
  const double s = (uv * dot(v, w) - vv * dot(u, w)) / det;
  const double t = (uu * dot(v, w) - uv * dot(u, w)) / det;
  if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0)
    least = std::min(least, norm(w + s * u - t * v));
  return least;
}

/// Distance from a polygon's border.
double to_border(const Vec3& point, const Corners3& corners) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < corners.size(); ++k)
    least = std::min(least, to_segment(point, corners[k], corners[(k + 1) % corners.size()]));
  return least;
}

/// Whether the foot of a point lies in a convex polygon.
bool above(const Vec3& point, const Corners3& corners, const Vec3& normal) {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 side = corners[(k + 1) % corners.size()] - corners[k];
    if (dot(cross(side, point - corners[k]), normal) < 0.0) return false;
  }
  return true;
}

double to_polygon(const Vec3& point, const Corners3& corners, const Vec3& normal) {
  if (above(point, corners, normal)) return std::abs(dot(point - corners[0], normal));
  return to_border(point, corners);
}

/// Where a line through `origin` along `direction` is in a polygon, both ways; false: nowhere.
bool reach_in(const Corners3& corners, const Vec3& normal, const Vec3& plane_point,
              const Vec3& direction, double size, double& begin, double& end) {
  begin = std::numeric_limits<double>::infinity();
  end = -begin;
  const auto take = [&](const Vec3& x) {
    begin = std::min(begin, dot(x, direction));
    end = std::max(end, dot(x, direction));
  };
  const auto height = [&](const Vec3& x) {
    const double h = dot(x - plane_point, normal);
    return std::abs(h) <= on_it * size ? 0.0 : h;
  };
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 &a = corners[k], &b = corners[(k + 1) % corners.size()];
    const double ha = height(a), hb = height(b);
    if (ha == 0.0) take(a);
    if (ha * hb < 0.0) take(a + (ha / (ha - hb)) * (b - a));
  }
  return begin <= end;
}

}  // namespace

Vec3 area_vector(const Corners3& polygon) {
  Vec3 sum{};
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
    sum += 0.5 * cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
  return sum;
}

Corners3 clipped(Corners3 polygon, const Vec3& low, const Vec3& high) {
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const auto part = [axis](const Vec3& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
    const double bound = part(side % 2 == 0 ? low : high), sign = side % 2 == 0 ? 1.0 : -1.0;
    const auto set_part = [axis](Vec3& v, double to) {
      (axis == 0 ? v.x : axis == 1 ? v.y : v.z) = to;
    };
    Corners3 kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      const double ha = sign * (part(a) - bound), hb = sign * (part(b) - bound);
      if (ha >= 0.0) kept.push_back(a);
      if (ha * hb < 0.0) {
        kept.push_back(a + (ha / (ha - hb)) * (b - a));
        set_part(kept.back(), bound);
      }
    }
    polygon = std::move(kept);
  }
  return polygon;
}

CrackNetwork::Polygon CrackNetwork::polygon_of(Corners3 corners, bool face) {
  Polygon p{std::move(corners), {}, {}, {}, face};
  const Vec3 area = area_vector(p.corners);
  p.normal = (1.0 / norm(area)) * area;
  p.low = p.high = p.corners[0];
  for (const Vec3& x : p.corners) {
    p.low = {std::min(p.low.x, x.x), std::min(p.low.y, x.y), std::min(p.low.z, x.z)};
    p.high = {std::max(p.high.x, x.x), std::max(p.high.y, x.y), std::max(p.high.z, x.z)};
  }
  return p;
}

bool CrackNetwork::far_from_border(const Vec3& point, const Polygon& of) const {
  const double apart = to_border(point, of.corners);
  return apart >= clear_ || apart <= on_it * norm(of.high - of.low);
}

bool CrackNetwork::keep_clear(const Polygon& p, const Polygon& q, std::vector<Line>& lines) const {
  const Vec3 gap{std::max(p.low.x - q.high.x, q.low.x - p.high.x),
                 std::max(p.low.y - q.high.y, q.low.y - p.high.y),
                 std::max(p.low.z - q.high.z, q.low.z - p.high.z)};
  if (std::max({gap.x, gap.y, gap.z}) >= clear_) return true;
  const double size = norm(p.high - p.low) + norm(q.high - q.low);
  const auto touches = [&](double apart) { return apart < clear_ && apart > on_it * size; };
  for (const Vec3& x : p.corners)
    if (touches(to_polygon(x, q.corners, q.normal))) return false;
  for (const Vec3& x : q.corners)
    if (touches(to_polygon(x, p.corners, p.normal))) return false;
  const Vec3 across = cross(p.normal, q.normal);
  double p_begin = 0.0, p_end = 0.0, q_begin = 0.0, q_end = 0.0;
  bool meet = norm(across) > 1e-12;
  const Vec3 direction = meet ? (1.0 / norm(across)) * across : Vec3{};
  meet = meet && reach_in(p.corners, q.normal, q.corners[0], direction, size, p_begin, p_end) &&
         reach_in(q.corners, p.normal, p.corners[0], direction, size, q_begin, q_end);
  const double begin = std::max(p_begin, q_begin), end = std::min(p_end, q_end);
  if (!meet || begin > end) {
    for (std::size_t i = 0; i < p.corners.size(); ++i)
      for (std::size_t j = 0; j < q.corners.size(); ++j)
        if (between_segments(p.corners[i], p.corners[(i + 1) % p.corners.size()], q.corners[j],
                             q.corners[(j + 1) % q.corners.size()]) < clear_)
          return false;
    return true;
  }
  if (norm(across) < least_angle_sine || end - begin < clear_) return false;
  // The point of both planes that is nearest to p's first corner, and from there along the line.
  const double hp = dot(p.normal, p.corners[0]), hq = dot(q.normal, q.corners[0]);
  const double c = dot(p.normal, q.normal), det = 1.0 - c * c;
  const Vec3 on_line = ((hp - c * hq) / det) * p.normal + ((hq - c * hp) / det) * q.normal;
  const auto at = [&](double t) { return on_line + t * direction; };
  for (const auto& [own, other, t] :
       {std::tuple{p_begin, q_begin, begin}, std::tuple{p_end, q_end, end}}) {
    if (t == own && !far_from_border(at(t), q)) return false;
    if (t == other && !far_from_border(at(t), p)) return false;
  }
  lines.push_back({at(begin), at(end)});
  return true;
}

bool CrackNetwork::fits(const Corners3& polygon) const {
  if (!(clear_ > 0.0)) return true;
  const Polygon p = polygon_of(polygon, false);
  std::vector<std::pair<std::size_t, Line>> found;
  for (std::size_t k = 0; k < polygons_.size(); ++k) {
    std::vector<Line> lines;
    if (!keep_clear(p, polygons_[k], lines)) return false;
    for (const Line& line : lines) found.emplace_back(k, line);
  }
  const auto near = [&](const Line& a, const Line& b) {
    return std::min(std::min(to_segment(a[0], b[0], b[1]), to_segment(a[1], b[0], b[1])),
                    std::min(to_segment(b[0], a[0], a[1]), to_segment(b[1], a[0], a[1]))) < clear_;
  };
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (!(polygons_[found[i].first].face && polygons_[found[j].first].face) &&
          near(found[i].second, found[j].second))
        return false;
    for (const Meeting& m : meetings_)
      if ((m.first == found[i].first || m.second == found[i].first) &&
          near(found[i].second, m.line))
        return false;
  }
  return true;
}

void CrackNetwork::add(Corners3 corners, bool face) {
  if (!(clear_ > 0.0)) return;
  Polygon p = polygon_of(std::move(corners), face);
  for (std::size_t k = 0; k < polygons_.size() && !face; ++k) {
    std::vector<Line> lines;
    keep_clear(p, polygons_[k], lines);
    for (const Line& line : lines) meetings_.push_back({polygons_.size(), k, line});
  }
  polygons_.push_back(std::move(p));
}

}  // namespace breccia::prepare
