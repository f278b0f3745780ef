#include "fdem/setup/regions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "core/region.hpp"
#include "exec/error.hpp"
#include "fdem/setup/mesh_edges.hpp"

namespace breccia::fdem {
namespace {

/// Membership of a region, with its names looked up once.
class Region {
 public:
  Region(const Model& model, const RegionConfig& config, const std::string& where)
      : model_(model), config_(config) {
    if (!config.on.empty()) {
      const auto found = std::find(model.groups.begin(), model.groups.end(), config.on);
      if (found == model.groups.end())
        throw InputError(where + ".on = \"" + config.on + "\" is not a body");
      group_ = static_cast<std::int16_t>(found - model.groups.begin());
    }
    if (config.edges.empty()) return;
    const auto found =
        std::find_if(model.edge_sets.begin(), model.edge_sets.end(),
                     [&](const Model::EdgeSet& s) { return s.name == config.edges; });
    if (found == model.edge_sets.end()) {
      std::string known;
      for (const Model::EdgeSet& s : model.edge_sets) known += (known.empty() ? "" : ", ") + s.name;
      throw InputError(where + ".edges = \"" + config.edges +
                       "\" is no line of a mesh; there are: " + (known.empty() ? "none" : known));
    }
    for (const auto& edge : found->edges) {
      lines_.insert(std::minmax(edge[0], edge[1]));
      on_lines_.insert(edge.begin(), edge.end());
    }
  }

  bool takes(std::size_t triangle, Index vertex) const {
    if (group_ >= 0 && model_.group[triangle] != group_) return false;
    if (!config_.edges.empty() && on_lines_.count(vertex) == 0) return false;
    const Vec2& x = model_.point[static_cast<std::size_t>(vertex)];
    bool inside = x.x >= config_.min.x && x.y >= config_.min.y && x.x <= config_.max.x &&
                  x.y <= config_.max.y;
    if (config_.radius > 0.0) inside = inside && in_circle(config_.center, config_.radius, x);
    if (!config_.polygon.empty()) inside = inside && in_polygon(config_.polygon, x);
    return inside != config_.outside;
  }
  bool takes_line(Index a, Index b) const {
    return config_.edges.empty() || lines_.count(std::minmax(a, b)) != 0;
  }

  /// "; the nearest, at (x, y) m, is 0.001 m away", of boxes and circles alone.
  std::string nearest_corner() const {
    if (config_.outside || !config_.polygon.empty() || !config_.edges.empty()) return "";
    double least = no_limit;
    Vec2 at{};
    for (std::size_t t = 0; t < model_.triangle.size(); ++t) {
      if (group_ >= 0 && model_.group[t] != group_) continue;
      for (const Index vertex : model_.triangle[t]) {
        const Vec2& x = model_.point[static_cast<std::size_t>(vertex)];
        const Vec2 beside{std::max({config_.min.x - x.x, x.x - config_.max.x, 0.0}),
                          std::max({config_.min.y - x.y, x.y - config_.max.y, 0.0})};
        const Vec2 out = x - config_.center;
        double away = std::sqrt(dot(beside, beside));
        if (config_.radius > 0.0) away = std::max(away, std::sqrt(dot(out, out)) - config_.radius);
        if (away >= least) continue;
        least = away;
        at = x;
      }
    }
    char text[120];
    std::snprintf(text, sizeof text, "; the nearest, at (%.4g, %.4g) m, is %.3g m away", at.x, at.y,
                  least);
    return least < no_limit ? text : "";
  }

 private:
  const Model& model_;
  const RegionConfig& config_;
  std::int16_t group_ = -1;
  std::set<std::pair<Index, Index>> lines_;
  std::set<Index> on_lines_;
};

}  // namespace

std::vector<Index> corners_in(const Model& model, const RegionConfig& config,
                              const std::string& where) {
  const Region region(model, config, where);
  std::vector<Index> corners;
  for (std::size_t t = 0; t < model.triangle.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (region.takes(t, model.triangle[t][k])) corners.push_back(static_cast<Index>(3 * t + k));
  if (corners.empty())
    throw InputError(where + ": its region holds no corner of any triangle" +
                     region.nearest_corner());
  return corners;
}

std::vector<Index> edges_in(const Model& model, const RegionConfig& config,
                            const std::string& where, bool needed) {
  const Region region(model, config, where);
  std::vector<Index> edges;
  for (const MeshEdge& e : mesh_edges(model))
    if (e.b < 0 && region.takes_line(e.low, e.high) &&
        region.takes(static_cast<std::size_t>(e.a / 3), e.low) &&
        region.takes(static_cast<std::size_t>(e.a / 3), e.high))
      edges.push_back(e.a);
  if (edges.empty() && needed) throw InputError(where + ": its region holds no edge on the border");
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::vector<Index> vertices_in(const Model& model, const RegionConfig& config,
                               const std::string& where) {
  std::vector<Index> vertices;
  for (const Index corner : corners_in(model, config, where))
    vertices.push_back(
        model.triangle[static_cast<std::size_t>(corner / 3)][static_cast<std::size_t>(corner % 3)]);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace breccia::fdem
