#include "io/vtu/touching.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace breccia {
namespace {

Frame begun(const Frame& like) {
  Frame frame;
  frame.step = like.step;
  frame.time = like.time;
  return frame;
}
void push(std::vector<float>& values, const Vec3& v) {
  for (const double c : {v.x, v.y, v.z}) values.push_back(static_cast<float>(c));
}

/// Two triangles of a plane wider than that space.
std::vector<Vec3> rectangle(const FrameWall& plane, const Around& space) {
  const Vec3& n = plane.normal;
  const Vec3 along = std::fabs(n.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 first = along - dot(along, n) * n;
  const std::array<Vec3, 2> axes{(1.0 / norm(first)) * first,
                                 cross(n, (1.0 / norm(first)) * first)};
  std::array<double, 2> low{1e300, 1e300}, high{-1e300, -1e300};
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner{(k & 1) != 0 ? space.high.x : space.low.x,
                      (k & 2) != 0 ? space.high.y : space.low.y,
                      (k & 4) != 0 ? space.high.z : space.low.z};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double at = dot(corner - plane.point, axes[axis]);
      low[axis] = std::min(low[axis], at);
      high[axis] = std::max(high[axis], at);
    }
  }
  const double margin = 0.03 * norm(space.high - space.low);
  const auto corner = [&](double a, double b) { return plane.point + a * axes[0] + b * axes[1]; };
  const Vec3 p = corner(low[0] - margin, low[1] - margin),
             q = corner(high[0] + margin, low[1] - margin),
             r = corner(high[0] + margin, high[1] + margin),
             s = corner(low[0] - margin, high[1] + margin);
  return {p, q, r, p, r, s};
}

}  // namespace

void Around::add(const std::vector<Vec3>& points) {
  for (const Vec3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
}
void Around::add(const Around& other) {
  if (other.low.x > other.high.x) return;  // of no points
  add(std::vector<Vec3>{other.low, other.high});
}

void Touching::sort() {
  std::sort(contacts.begin(), contacts.end(), [](const FrameContact& c, const FrameContact& d) {
    return std::tie(c.a, c.b) < std::tie(d.a, d.b);
  });
}

Frame contacts_frame(const Frame& like, const Touching& sorted) {
  const char* const unit = sorted.plane ? "N/m" : "N";
  Frame frame = begun(like);
  FrameField size{"force", unit, 1, {}}, force{"force_on_b", unit, 3, {}};
  std::vector<std::int32_t> a, b, wall;
  for (const FrameContact& c : sorted.contacts) {
    for (const Vec3& end : {c.at_a, c.at_b}) {
      frame.lines.push_back(static_cast<std::int32_t>(frame.position.size()));
      frame.position.push_back(end);
    }
    size.values.push_back(static_cast<float>(norm(c.force)));
    push(force.values, c.force);
    a.push_back(c.a);
    b.push_back(std::max(c.b, -1));
    wall.push_back(c.b < 0 ? -1 - c.b : -1);
  }
  frame.line_fields = {std::move(size), std::move(force), whole_numbers("a", std::move(a)),
                       whole_numbers("b", std::move(b)), whole_numbers("wall", std::move(wall))};
  return frame;
}

Frame walls_frame(const Frame& like, const Touching& sorted) {
  std::vector<Vec3> pushed(like.walls.size());
  for (const FrameContact& c : sorted.contacts)
    if (c.b < 0) pushed[static_cast<std::size_t>(-1 - c.b)] += c.force;
  Frame frame = begun(like);
  FrameField force{"force", "N", 3, {}};
  std::vector<std::int32_t> number;
  for (std::size_t k = 0; k < like.walls.size(); ++k) {
    const FrameWall& wall = like.walls[k];
    for (const Vec3& corner :
         wall.corners.empty() ? rectangle(wall, sorted.around) : wall.corners) {
      frame.triangles.push_back(static_cast<std::int32_t>(frame.position.size()));
      frame.position.push_back(corner);
      if (frame.triangles.size() % 3 != 0) continue;
      number.push_back(static_cast<std::int32_t>(k));
      push(force.values, pushed[k]);
    }
  }
  frame.triangle_fields = {whole_numbers("wall", std::move(number)), std::move(force)};
  return frame;
}

Frame bolts_frame(const Frame& like, bool plane) {
  Frame frame = begun(like);
  const char* const unit = plane ? "N/m" : "N";
  FrameField force{"force", unit, 1, {}}, across{"across", unit, 1, {}}, slip{"slip", "m", 1, {}};
  std::vector<std::int32_t> bolt;
  for (const FrameBar& bar : like.bars) {
    for (const Vec3& end : {bar.begin, bar.end}) {
      frame.lines.push_back(static_cast<std::int32_t>(frame.position.size()));
      frame.position.push_back(end);
    }
    force.values.push_back(bar.force);
    across.values.push_back(bar.across);
    slip.values.push_back(bar.slip);
    bolt.push_back(bar.bolt);
  }
  frame.line_fields = {std::move(force), std::move(across), std::move(slip),
                       whole_numbers("bolt", std::move(bolt))};
  return frame;
}

void add_touching(FrameContents& files, const Frame& like, Touching touching, FrameFormat format,
                  int threads) {
  touching.sort();
  if (like.bolted)
    files.bolts = contents_of(bolts_frame(like, touching.plane), threads, format).lines;
  files.contacts = contents_of(contacts_frame(like, touching), threads, format).lines;
  if (!like.walls.empty())
    files.walls = contents_of(walls_frame(like, touching), threads, format).points;
}

}  // namespace breccia
