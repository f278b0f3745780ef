#include "fdem/setup/mesh_edges.hpp"

#include <algorithm>

#include "exec/error.hpp"

namespace breccia::fdem {

std::vector<MeshEdge> mesh_edges(const Model& model) {
  struct Side {
    Index low, high, edge;
  };
  std::vector<Side> sides;
  sides.reserve(3 * model.triangle.size());
  for (Index t = 0; t < model.size(); ++t) {
    const auto& corners = model.triangle[static_cast<std::size_t>(t)];
    for (Index k = 0; k < 3; ++k) {
      const Index from = corners[static_cast<std::size_t>(k)];
      const Index to = corners[static_cast<std::size_t>((k + 1) % 3)];
      sides.push_back({std::min(from, to), std::max(from, to), 3 * t + k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.edge < b.edge;
  });
  std::vector<MeshEdge> edges;
  for (const Side& s : sides) {
    if (edges.empty() || edges.back().low != s.low || edges.back().high != s.high) {
      edges.push_back({s.low, s.high, s.edge, -1});
      continue;
    }
    MeshEdge& e = edges.back();
    const auto start = [&](Index edge) {
      return model.triangle[static_cast<std::size_t>(edge / 3)][static_cast<std::size_t>(edge % 3)];
    };
    if (e.b >= 0 || start(e.a) == start(s.edge))
      throw InputError("triangle " + std::to_string(s.edge / 3) + " overlaps triangle " +
                       std::to_string(e.a / 3) +
                       ": an edge belongs to two triangles at most, one on each side");
    e.b = s.edge;
  }
  return edges;
}

}  // namespace breccia::fdem
