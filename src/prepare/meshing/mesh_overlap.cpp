#include "prepare/meshing/mesh_overlap.hpp"

#include <algorithm>
#include <cmath>

namespace breccia::prepare {
namespace {

std::array<Vec2, 3> corners_of(const std::vector<Vec2>& point, const Triangle& t) {
  return {at(point, t[0]), at(point, t[1]), at(point, t[2])};
}

struct Box {
  Vec2 low, high;
  bool meets(const Box& b) const {
    return low.x < b.high.x && b.low.x < high.x && low.y < b.high.y && b.low.y < high.y;
  }
};
Box box_of(const std::array<Vec2, 3>& c) {
  return {{std::min({c[0].x, c[1].x, c[2].x}), std::min({c[0].y, c[1].y, c[2].y})},
          {std::max({c[0].x, c[1].x, c[2].x}), std::max({c[0].y, c[1].y, c[2].y})}};
}

/// Whether a direction lies between two others, which are less than half a turn apart.
bool is_between(const Vec2& direction, const Vec2& first, const Vec2& last) {
  constexpr double flat = 1e-9;
  return cross(first, direction) > flat * norm(first) * norm(direction) &&
         cross(direction, last) > flat * norm(direction) * norm(last);
}

/// Whether triangles, given counterclockwise, lie apart because they share a vertex and not the
/// angle at it: as neighbours do, of which a mesh has many.
bool meet_at_a_vertex(const std::vector<Vec2>& point, const Triangle& a, const Triangle& b) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      if (a[i] != b[j]) continue;
      const Vec2 at = point[static_cast<std::size_t>(a[i])];
      const auto side = [&](const Triangle& t, std::size_t k) {
        return point[static_cast<std::size_t>(t[k % 3])] - at;
      };
      const Vec2 a1 = side(a, i + 1), a2 = side(a, i + 2), b1 = side(b, j + 1), b2 = side(b, j + 2);
      const bool apart = !is_between(b1, a1, a2) && !is_between(b2, a1, a2) &&
                         !is_between(a1, b1, b2) && !is_between(a2, b1, b2) &&
                         !is_between(b1 + b2, a1, a2);
      return apart;
    }
  return false;
}

}  // namespace

double shared_area(const std::array<Vec2, 3>& a, const std::array<Vec2, 3>& b) {
  // Sutherland and Hodgman: a is cut by the three sides of b.
  std::vector<Vec2> polygon(a.begin(), a.end());
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 from = b[k], side = b[(k + 1) % 3] - from;
    std::vector<Vec2> inside;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
      const double dp = cross(side, p - from), dq = cross(side, q - from);
      if (dp >= 0.0) inside.push_back(p);
      if ((dp > 0.0 && dq < 0.0) || (dp < 0.0 && dq > 0.0))
        inside.push_back(p + (dp / (dp - dq)) * (q - p));
    }
    polygon.swap(inside);
    if (polygon.size() < 3) return 0.0;
  }
  double area = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    area += 0.5 * cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return area;
}

std::vector<Overlap> overlaps_of(const std::vector<Vec2>& point,
                                 const std::vector<Triangle>& triangles) {
  std::vector<Box> boxes;
  double edge = 0.0;
  for (const Triangle& t : triangles) {
    boxes.push_back(box_of(corners_of(point, t)));
    edge += boxes.back().high.x - boxes.back().low.x + boxes.back().high.y - boxes.back().low.y;
  }
  if (triangles.empty()) return {};
  edge /= static_cast<double>(triangles.size());  // about two triangles

  // Each triangle is entered in every cell that its box touches.
  struct Entry {
    double row, column;
    Index triangle;
    bool operator<(const Entry& e) const {
      return row != e.row         ? row < e.row
             : column != e.column ? column < e.column
                                  : triangle < e.triangle;
    }
  };
  std::vector<Entry> entries;
  for (std::size_t t = 0; t < boxes.size(); ++t)
    for (double row = std::floor(boxes[t].low.y / edge); row * edge <= boxes[t].high.y; ++row)
      for (double column = std::floor(boxes[t].low.x / edge); column * edge <= boxes[t].high.x;
           ++column)
        entries.push_back({row, column, static_cast<Index>(t)});
  std::sort(entries.begin(), entries.end());

  std::vector<Overlap> found;
  for (std::size_t i = 0; i < entries.size(); ++i)
    for (std::size_t j = i + 1; j < entries.size() && entries[j].row == entries[i].row &&
                                entries[j].column == entries[i].column;
         ++j) {
      const auto a = static_cast<std::size_t>(entries[i].triangle),
                 b = static_cast<std::size_t>(entries[j].triangle);
      if (!boxes[a].meets(boxes[b]) || meet_at_a_vertex(point, triangles[a], triangles[b]))
        continue;
      const double smaller =
          std::min(signed_area(point, triangles[a]), signed_area(point, triangles[b]));
      if (shared_area(corners_of(point, triangles[a]), corners_of(point, triangles[b])) >
          1e-6 * smaller)
        found.push_back({entries[i].triangle, entries[j].triangle});
    }
  const auto key = [](const Overlap& o) { return std::pair(o.a, o.b); };
  std::sort(found.begin(), found.end(),
            [&](const Overlap& x, const Overlap& y) { return key(x) < key(y); });
  found.erase(std::unique(found.begin(), found.end(),
                          [&](const Overlap& x, const Overlap& y) { return key(x) == key(y); }),
              found.end());
  return found;
}

}  // namespace breccia::prepare
