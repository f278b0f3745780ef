#include "prepare/shapes/surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "math/bounds.hpp"
#include "prepare/shapes/segments.hpp"

namespace breccia::prepare {
namespace {

using Triangle = Surface::Triangle;
std::vector<Vec3> middles(const std::vector<Triangle>& triangles) {
  std::vector<Vec3> all;
  for (const Triangle& t : triangles)
    all.push_back(0.5 *
                  (least_of(least_of(t[0], t[1]), t[2]) + most_of(most_of(t[0], t[1]), t[2])));
  return all;
}
double half_width(const std::vector<Triangle>& triangles) {
  double widest = 0.0;
  for (const Triangle& t : triangles) {
    const Vec3 span = most_of(most_of(t[0], t[1]), t[2]) - least_of(least_of(t[0], t[1]), t[2]);
    widest = std::max({widest, span.x, span.y, span.z});
  }
  return 0.5 * widest;
}
std::vector<Vec3> flattened(std::vector<Vec3> points) {
  for (Vec3& p : points) p.z = 0.0;
  return points;
}

/// Each edge of a closed surface belongs to two triangles, which run along it in opposite ways.
void refuse_open(const std::vector<Triangle>& triangles, const std::string& name) {
  std::map<std::pair<Place, Place>, int> edges;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{place_of(t[k]), place_of(t[(k + 1) % 3])}];
  std::size_t open = 0;
  const Place* first = nullptr;
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count == 1 && back != edges.end() && back->second == 1) continue;
    if (++open == 1) first = &edge.first;
  }
  if (triangles.size() < 4 || open > 0)
    throw InputError(fmt::format(
        "{}: the surface is not closed: {}", name,
        first == nullptr
            ? fmt::format("it has {} triangles", triangles.size())
            : fmt::format("{} edges are not shared by two triangles that turn alike; one is at "
                          "({:.6g}, {:.6g}, {:.6g}) m",
                          open, (*first)[0], (*first)[1], (*first)[2])));
}

/// Whether p lies under or over an edge's triangle: how often a line from p along -x, in the plane
/// of x and y, crosses the edge. Ends are taken in one order, so that both triangles of an edge
/// agree to the bit.
bool crosses_edge(const Vec3& p, Vec3 a, Vec3 b) {
  if ((a.y > p.y) == (b.y > p.y)) return false;
  if (place_of(b) < place_of(a)) std::swap(a, b);
  return p.x > a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
}
/// Whether the triangle lies above p.
bool above(const Triangle& t, const Vec3& p) {
  const bool covered =
      crosses_edge(p, t[0], t[1]) ^ crosses_edge(p, t[1], t[2]) ^ crosses_edge(p, t[2], t[0]);
  if (!covered) return false;
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  return n.z != 0.0 && dot(n, t[0] - p) / n.z > 0.0;
}

/// From p to the nearest point of a triangle (Ericson 2005, "Real-Time Collision
/// Detection", 5.1.5).
double distance_to(const Triangle& t, const Vec3& p) {
  const auto& [a, b, c] = t;
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return norm(ap);
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return norm(bp);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return norm(ap - d1 / (d1 - d3) * ab);
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return norm(cp);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return norm(ap - d2 / (d2 - d6) * ac);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
    return norm(bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b));
  const double all = va + vb + vc;
  return norm(ap - vb / all * ab - vc / all * ac);
}

/// Where a segment meets a triangle, as a share of its length; below 0: nowhere, or in its plane
/// (Möller and Trumbore 1997).
double met_at(const Triangle& t, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from, e1 = t[1] - t[0], e2 = t[2] - t[0];
  const Vec3 h = cross(along, e2);
  const double det = dot(e1, h);
  if (det == 0.0) return -1.0;
  const Vec3 s = from - t[0];
  const double u = dot(s, h) / det;
  if (u < 0.0 || u > 1.0) return -1.0;
  const Vec3 q = cross(s, e1);
  const double v = dot(along, q) / det;
  if (v < 0.0 || u + v > 1.0) return -1.0;
  const double at = dot(e2, q) / det;
  return at >= 0.0 && at <= 1.0 ? at : -1.0;
}

double edge_of_cells(const std::vector<Triangle>& triangles) {
  double sum = 0.0;
  for (const Triangle& t : triangles) sum += norm(t[1] - t[0]);
  return std::max(sum / static_cast<double>(std::max<std::size_t>(triangles.size(), 1)), 1e-12);
}

constexpr std::size_t header = 80, record = 50;
constexpr double farthest = 1e9;  ///< of a corner from the origin; its square is a number  [m]

bool is_place(const Vec3& v) {  // no coordinate that is no number is
  return std::abs(v.x) <= farthest && std::abs(v.y) <= farthest && std::abs(v.z) <= farthest;
}

std::vector<Triangle> triangles_of_bytes(const std::string& content, const std::string& path,
                                         double unit) {
  std::vector<Triangle> triangles;
  for (std::size_t at = header + 4; at + record <= content.size(); at += record) {
    std::array<float, 12> v{};  // normal, three corners
    std::memcpy(v.data(), content.data() + at, sizeof v);
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k)
      t[k] = unit * Vec3{double{v[3 * k + 3]}, double{v[3 * k + 4]}, double{v[3 * k + 5]}};
    if (!std::all_of(t.begin(), t.end(), is_place))
      throw InputError(
          fmt::format("{}: triangle {} has a corner that is no number, or farther "
                      "than {:g} m from the origin",
                      path, triangles.size(), farthest));
    triangles.push_back(t);
  }
  return triangles;
}

std::vector<Triangle> triangles_of_text(const std::string& content, const std::string& path,
                                        double unit) {
  std::vector<Triangle> triangles;
  std::istringstream lines(content);
  std::vector<Vec3> corners;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "vertex") {
      std::array<double, 3> v{};
      bool good = true;
      for (double& x : v) {
        words >> word;
        good = good && std::from_chars(word.data(), word.data() + word.size(), x).ec == std::errc{};
        good = good && words;
      }
      corners.push_back(unit * Vec3{v[0], v[1], v[2]});
      if (!good || !is_place(corners.back()))
        throw InputError(
            fmt::format("{}, line {}: not \"vertex x y z\", three numbers within "
                        "{:g} m of the origin",
                        path, number, farthest));
    } else if (word == "endfacet") {
      if (corners.size() != 3)
        throw InputError(
            fmt::format("{}, line {}: a facet of {} corners, not 3", path, number, corners.size()));
      triangles.push_back({corners[0], corners[1], corners[2]});
      corners.clear();
    }
  }
  return triangles;
}

}  // namespace

Surface::Surface(std::vector<Triangle> triangles, const std::string& name)
    : triangles_(std::move(triangles)),
      widest_(half_width(triangles_)),
      centres_(middles(triangles_)),
      near_(centres_, edge_of_cells(triangles_)),
      columns_(flattened(centres_), edge_of_cells(triangles_)) {
  refuse_open(triangles_, name);
  low_ = high_ = triangles_.front()[0];
  for (const Triangle& t : triangles_) {
    for (const Vec3& corner : t) {
      low_ = least_of(low_, corner);
      high_ = most_of(high_, corner);
    }
  }
  const Vec3 middle = 0.5 * (low_ + high_);
  for (const Triangle& t : triangles_)
    volume_ += dot(t[0] - middle, cross(t[1] - middle, t[2] - middle)) / 6.0;
  volume_ = std::abs(volume_);
  if (!(volume_ > 0.0)) throw InputError(name + ": the surface encloses no space");
}

bool Surface::holds(const Vec3& p) const {
  if (p.x < low_.x || p.y < low_.y || p.z < low_.z || p.x > high_.x || p.y > high_.y ||
      p.z > high_.z)
    return false;
  bool inside = false;
  columns_.visit({p.x, p.y, 0.0}, widest_, [&](Index k) {
    if (above(triangles_[static_cast<std::size_t>(k)], p)) inside = !inside;
  });
  return inside;
}

double Surface::distance(const Vec3& p, double reach) const {
  double least = std::min(reach, 2.0 * norm(high_ - low_));
  near_.visit(p, least + widest_, [&](Index k) {
    const Vec3 apart = centres_[static_cast<std::size_t>(k)] - p;
    const double far = least + widest_;
    if (std::abs(apart.x) > far || std::abs(apart.y) > far || std::abs(apart.z) > far) return;
    least = std::min(least, distance_to(triangles_[static_cast<std::size_t>(k)], p));
  });
  return least;
}

template <class Visit>
void Surface::each_near(const Vec3& a, const Vec3& b, double reach, Visit&& visit) const {
  const Vec3 middle = 0.5 * (a + b), half = 0.5 * (b - a);
  const double far =
      std::max({std::abs(half.x), std::abs(half.y), std::abs(half.z)}) + reach + widest_;
  near_.visit(middle, far, [&](Index k) {
    const Vec3 apart = centres_[static_cast<std::size_t>(k)] - middle;
    if (std::abs(apart.x) > far || std::abs(apart.y) > far || std::abs(apart.z) > far) return;
    visit(triangles_[static_cast<std::size_t>(k)]);
  });
}

Surface::Clearance Surface::clearance(const Vec3& a, const Vec3& b, double reach) const {
  Clearance least{reach, a};
  const auto lessen = [&](double distance, const Vec3& at) {
    if (distance < least.distance) least = {distance, at};
  };
  // In pieces: the box around a long slanting segment holds much that is far from it.
  const double length = norm(b - a), piece = 4.0 * (reach + widest_);
  const int pieces = 1 + static_cast<int>(std::min(length / piece, 1e6));
  for (int i = 0; i < pieces; ++i) {
    const Vec3 from = a + (static_cast<double>(i) / pieces) * (b - a);
    const Vec3 to = a + (static_cast<double>(i + 1) / pieces) * (b - a);
    each_near(from, to, reach, [&](const Triangle& t) {
      if (const double share = met_at(t, from, to); share >= 0.0)
        return lessen(0.0, from + share * (to - from));
      lessen(distance_to(t, from), from);
      lessen(distance_to(t, to), to);
      for (std::size_t k = 0; k < 3; ++k) {
        const NearestOfSegments near = nearest_of_segments(from, to, t[k], t[(k + 1) % 3]);
        lessen(near.distance, near.at);
      }
    });
  }
  return least;
}

bool Surface::parts(const Vec3& a, const Vec3& b) const {
  bool hit = false;
  each_near(a, b, 0.0, [&](const Triangle& t) { hit = hit || met_at(t, a, b) >= 0.0; });
  return hit;
}

std::vector<Triangle> read_triangles(const std::string& path, double unit) {
  const std::string content = read_whole_file(path);
  std::uint32_t count = 0;
  if (content.size() >= header + 4) std::memcpy(&count, content.data() + header, sizeof count);
  const bool bytes = content.size() == header + 4 + record * std::size_t{count};
  if (!bytes && !content.starts_with("solid"))
    throw InputError(path + ": not an STL file: neither text that begins with \"solid\" nor the " +
                     "bytes of as many triangles as it says");
  return bytes ? triangles_of_bytes(content, path, unit) : triangles_of_text(content, path, unit);
}

Surface read_surface(const std::string& path, double unit) {
  return Surface(read_triangles(path, unit), path);
}

}  // namespace breccia::prepare
