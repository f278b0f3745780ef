#include "prepare/tetrahedra/tet_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace breccia::prepare {
namespace {

using FourPoints = std::array<Vec3, 4>;

constexpr double least_depth = 1e-6;  ///< over an edge, see the header  [-]

FourPoints four_of(const std::vector<Vec3>& point, const Tetrahedron& t) {
  return {at(point, t[0]), at(point, t[1]), at(point, t[2]), at(point, t[3])};
}

std::pair<double, double> extent_along(const FourPoints& x, const Vec3& axis) {
  const std::array<double, 4> h{dot(x[0], axis), dot(x[1], axis), dot(x[2], axis), dot(x[3], axis)};
  return {std::min({h[0], h[1], h[2], h[3]}), std::max({h[0], h[1], h[2], h[3]})};
}

struct TetBox {
  Vec3 low, high;
  bool meets(const TetBox& b) const {
    return low.x < b.high.x && b.low.x < high.x && low.y < b.high.y && b.low.y < high.y &&
           low.z < b.high.z && b.low.z < high.z;
  }
  double edge() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};
TetBox box_of(const FourPoints& x) {
  TetBox box{x[0], x[0]};
  for (const Vec3& p : x) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

using Cell = std::array<double, 3>;  ///< whole numbers

template <class Visit>
void each_cell(const TetBox& box, double edge, const Visit& visit) {
  for (double i = std::floor(box.low.x / edge); i * edge <= box.high.x; ++i)
    for (double j = std::floor(box.low.y / edge); j * edge <= box.high.y; ++j)
      for (double k = std::floor(box.low.z / edge); k * edge <= box.high.z; ++k)
        visit(Cell{i, j, k});
}

/// Tetrahedra in the cells of a lattice that one on the surface touches.
std::vector<std::pair<Cell, Index>> crowded_cells(const std::vector<TetBox>& boxes,
                                                  const std::vector<bool>& outer) {
  double edge = 0.0;
  for (const TetBox& box : boxes) edge += box.edge();
  edge *= 1.5 / static_cast<double>(boxes.size());
  std::vector<Cell> cells;
  for (std::size_t t = 0; t < boxes.size(); ++t)
    if (outer[t]) each_cell(boxes[t], edge, [&](const Cell& cell) { cells.push_back(cell); });
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  // Most cells lie inside: a bit for their hash tells so without a look at the list.
  std::vector<bool> seen(std::size_t{1} << 22);
  const auto bit = [&seen](const Cell& cell) {
    std::uint64_t hash = 0;
    for (const double number : cell) {
      const double one_zero = number + 0.0;  // not two
      std::uint64_t bits = 0;
      std::memcpy(&bits, &one_zero, sizeof bits);
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15U;
      hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash % seen.size());
  };
  for (const Cell& cell : cells) seen[bit(cell)] = true;
  std::vector<std::pair<Cell, Index>> entries;
  for (std::size_t t = 0; t < boxes.size(); ++t)
    each_cell(boxes[t], edge, [&](const Cell& cell) {
      if (seen[bit(cell)] && std::binary_search(cells.begin(), cells.end(), cell))
        entries.emplace_back(cell, static_cast<Index>(t));
    });
  std::sort(entries.begin(), entries.end());
  return entries;
}

}  // namespace

double shared_depth(const FourPoints& a, const FourPoints& b) {
  double least = 1e300;
  const auto separates = [&](const Vec3& axis, double length) {
    const auto [low_a, high_a] = extent_along(a, axis);
    const auto [low_b, high_b] = extent_along(b, axis);
    least = std::min(least, std::min(high_a - low_b, high_b - low_a) / length);
    return least <= 0.0;
  };
  for (const FourPoints* x : {&a, &b})
    for (const auto& k : face_corners) {
      const Vec3 normal = cross((*x)[k[1]] - (*x)[k[0]], (*x)[k[2]] - (*x)[k[0]]);
      if (separates(normal, norm(normal))) return least;
    }
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t l = 0; l < k; ++l) {
          const Vec3 u = a[i] - a[j], v = b[k] - b[l], axis = cross(u, v);
          if (norm(axis) > 1e-9 * norm(u) * norm(v) && separates(axis, norm(axis))) return least;
        }
  return least;
}

std::vector<TetOverlap> overlaps_of(const std::vector<Vec3>& point,
                                    const std::vector<Tetrahedron>& tetrahedra,
                                    const std::vector<MeshFace>& faces) {
  if (tetrahedra.empty()) return {};
  std::vector<TetBox> boxes;
  boxes.reserve(tetrahedra.size());
  for (const Tetrahedron& t : tetrahedra) boxes.push_back(box_of(four_of(point, t)));
  std::vector<bool> outer(tetrahedra.size());
  for (const MeshFace& face : faces)
    if (face.tetrahedra[1] < 0) outer[static_cast<std::size_t>(face.tetrahedra[0])] = true;
  const auto entries = crowded_cells(boxes, outer);
  std::vector<std::pair<Index, Index>> found;
  for (std::size_t i = 0; i < entries.size(); ++i)
    for (std::size_t j = i + 1; j < entries.size() && entries[j].first == entries[i].first; ++j) {
      const auto a = static_cast<std::size_t>(entries[i].second),
                 b = static_cast<std::size_t>(entries[j].second);
      if (!(outer[a] || outer[b]) || !boxes[a].meets(boxes[b])) continue;
      if (shared_depth(four_of(point, tetrahedra[a]), four_of(point, tetrahedra[b])) >
          least_depth * std::min(boxes[a].edge(), boxes[b].edge()))
        found.emplace_back(entries[i].second, entries[j].second);
    }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  std::vector<TetOverlap> overlaps;
  for (const auto& [a, b] : found) overlaps.push_back({a, b});
  return overlaps;
}

}  // namespace breccia::prepare
