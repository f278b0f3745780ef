#include "prepare/meshing/crack_path.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>

#include "prepare/meshing/body_mesh.hpp"
#include "prepare/meshing/mesh_check.hpp"

namespace breccia::prepare {
namespace {

using Line = std::array<Vec2, 2>;

constexpr double band = 3.0;  ///< width of the search on each side, over the mean edge  [-]
constexpr double path_reach =
    0.75;  ///< an end is in the mesh if a vertex is so near, over the mean edge

/// The part of a mesh near a line: vertices and edges that a path may use.
class Band {
 public:
  Band(const Line& line, const std::vector<Vec2>& point, const std::vector<MeshEdge>& edges,
       double mean_edge)
      : line_(line), point_(point), mean_edge_(mean_edge) {
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const Index a = edges[e].ends[0], b = edges[e].ends[1];
      const Vec2 middle = 0.5 * (at(point, a) + at(point, b));
      const double far = std::max({distance(at(point, a), line), distance(at(point, b), line)});
      if (far > band * mean_edge) continue;
      const double away =
          (distance(at(point, a), line) + distance(at(point, b), line) + distance(middle, line)) /
          (3.0 * mean_edge);
      const double cost = norm(at(point, a) - at(point, b)) * (1.0 + 10.0 * away * away);
      around_[a].push_back({b, static_cast<Index>(e), cost});
      around_[b].push_back({a, static_cast<Index>(e), cost});
    }
  }

  /// The paths through each connected region, as edges.
  std::vector<Index> paths() {
    std::vector<Index> path;
    std::map<Index, bool> seen;
    for (const auto& entry : around_) {
      if (seen[entry.first]) continue;
      std::vector<Index> region{entry.first};
      seen[entry.first] = true;
      for (std::size_t k = 0; k < region.size(); ++k)
        for (const Step& step : around_[region[k]])
          if (!seen[step.to]) {
            seen[step.to] = true;
            region.push_back(step.to);
          }
      const Index from = end_of(region, line_), to = end_of(region, {line_[1], line_[0]});
      if (from >= 0 && to >= 0 && from != to) follow(from, to, path);
    }
    return path;
  }

 private:
  struct Step {
    Index to, edge;
    double cost;  ///<  [m]
  };

  /// The vertex of a region where a line begins, or enters it; -1 if it passes by.
  Index end_of(const std::vector<Index>& region, const Line& line) const {
    Index nearest = -1, first = -1;
    double least = 1e300, earliest = 1e300;
    const double length = norm(line[1] - line[0]);
    for (const Index v : region) {
      const Vec2 place = at(point_, v);
      const double away = norm(place - line[0]);
      if (away < least || (away == least && v < nearest)) {
        least = away;
        nearest = v;
      }
      const double aside = distance(place, line);
      if (aside > path_reach * mean_edge_) continue;
      const double along = dot(place - line[0], line[1] - line[0]) / length + 2.0 * aside;
      if (along < earliest || (along == earliest && v < first)) {
        earliest = along;
        first = v;
      }
    }
    return least <= path_reach * mean_edge_ ? nearest : first;
  }

  /// Dijkstra's shortest path; ties go to the lower vertex.
  void follow(Index from, Index to, std::vector<Index>& path) {
    struct Reached {
      double cost = 1e300;
      Index from = -1, edge = -1;
    };
    std::map<Index, Reached> reached;
    using Open = std::pair<double, Index>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    reached[from].cost = 0.0;
    open.push({0.0, from});
    while (!open.empty()) {
      const auto [cost, v] = open.top();
      open.pop();
      if (v == to) break;
      if (cost > reached[v].cost) continue;
      for (const Step& step : around_[v])
        if (Reached& next = reached[step.to]; cost + step.cost < next.cost) {
          next = {cost + step.cost, v, step.edge};
          open.push({next.cost, step.to});
        }
    }
    for (Index v = to; v != from; v = reached[v].from) path.push_back(reached[v].edge);
  }

  Line line_;
  const std::vector<Vec2>& point_;
  double mean_edge_;
  std::map<Index, std::vector<Step>> around_;
};

}  // namespace

std::vector<Edge> edges_along(const std::vector<Vec2>& polyline, const std::vector<Vec2>& point,
                              const std::vector<Triangle>& triangles) {
  const std::vector<MeshEdge> edges = edges_of(triangles);
  std::vector<Edge> found;
  for (std::size_t k = 1; k < polyline.size(); ++k) {
    const Line line{polyline[k - 1], polyline[k]};
    // The mean edge where the line runs: bodies may have meshes of different size.
    double sum = 0.0;
    Index count = 0;
    for (const MeshEdge& edge : edges) {
      const Vec2 a = at(point, edge.ends[0]), b = at(point, edge.ends[1]);
      const double length = norm(a - b);
      if (distance(0.5 * (a + b), line) > length) continue;
      sum += length;
      ++count;
    }
    if (count == 0) continue;
    for (const Index e : Band(line, point, edges, sum / count).paths())
      if (edges[static_cast<std::size_t>(e)].triangles[1] >= 0)
        found.push_back(edges[static_cast<std::size_t>(e)].ends);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace breccia::prepare
