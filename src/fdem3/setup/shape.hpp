#pragma once
// How tetrahedra are set up, by the words of fdem_shared/setup.

#include <string>
#include <vector>

#include "core/region.hpp"
#include "fdem3/world.hpp"

namespace breccia::fdem3 {

struct ShapeOfSetUp {
  struct AtStart {
    ShapeGradients reference;
    double mass;  ///< of a corner  [kg]
    double edge;  ///< of the regular tetrahedron as large  [m]
  };
  static AtStart at_start(const TetrahedronNodes& nodes, double density, std::size_t number);
  /// Supports of this stage: the place in Case::holds of each tetrahedron of the whole mesh, -1:
  /// free.
  static std::vector<Index> prescribe(World& w, const Config& config);
  static constexpr const char *side_words = "faces", *named_word = "surface";
  static const std::string& named_sides(const RegionConfig& region) { return region.faces; }
  static auto& side_sets(const Model& model) { return model.face_sets; }
  static auto& sides_of_set(const Model::FaceSet& set) { return set.faces; }
  /// Whether a point lies in the forms of a region besides its box.
  static bool is_within(const RegionConfig& region, const Vec3& x) {
    return (!(region.radius > 0.0) || in_round(region.center, region.radius, region.around, x)) &&
           (region.polygon.empty() || in_polygon(region.polygon, seen_along(region.around, x)));
  }
  static bool is_plain(const RegionConfig& region) {
    return region.polygon.empty() && (region.around.empty() || !(region.radius > 0.0));
  }
};

}  // namespace breccia::fdem3
