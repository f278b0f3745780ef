#include "fdem/setup/regions.hpp"

#include <algorithm>

#include "fdem/setup/mesh_edges.hpp"
#include "fdem/shape.hpp"
#include "fdem_shared/setup/regions.hpp"

namespace breccia::fdem {

std::vector<Index> corners_in(const Model& model, const RegionConfig& config,
                              const std::string& where) {
  return fdem_shared::corners_within<Shape>(model, config, where);
}

std::vector<Index> edges_in(const Model& model, const RegionConfig& config,
                            const std::string& where, const fdem_shared::LaidBare& bare,
                            bool needed) {
  const fdem_shared::Region<Shape, Model, RegionConfig> region(model, config, where);
  const auto group = [&](Index edge) { return at(model.group[at(edge / 3)]); };
  std::vector<Index> edges;
  for (const MeshEdge& e : mesh_edges(model)) {
    const Index own = bare.side(e.a, e.b, group);
    if (own >= 0 && region.takes_side(at(own / 3), {e.low, e.high})) edges.push_back(own);
  }
  if (edges.empty() && needed) throw InputError(bare.none_of(where, "edge"));
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
