#pragma once
// How triangles are set up, by the words of fdem_shared/setup.

#include <string>
#include <vector>

#include "core/region.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {

struct ShapeOfSetUp {
  struct AtStart {
    Mat2 reference;
    double mass;  ///< of a corner  [kg/m]
    double edge;  ///< of the equilateral triangle as large  [m]
  };
  static AtStart at_start(const TriangleNodes& nodes, double density, std::size_t number);
  /// Supports of this stage: the place in Case::holds of each triangle of the whole mesh, -1: free.
  static std::vector<Index> prescribe(World& w, const Config& config);
  static constexpr const char *side_words = "edges", *named_word = "line";
  static const std::string& named_sides(const RegionConfig& region) { return region.edges; }
  static auto& side_sets(const Model& model) { return model.edge_sets; }
  static auto& sides_of_set(const Model::EdgeSet& set) { return set.edges; }
  /// Whether a point lies in the forms of a region besides its box.
  static bool is_within(const RegionConfig& region, const Vec2& x) {
    return (!(region.radius > 0.0) || in_circle(region.center, region.radius, x)) &&
           (region.polygon.empty() || in_polygon(region.polygon, x));
  }
  static bool is_plain(const RegionConfig& region) { return region.polygon.empty(); }
};

}  // namespace breccia::fdem
