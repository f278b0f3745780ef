#include "fdem3/setup/regions.hpp"

#include <algorithm>
#include <set>

#include "core/region.hpp"
#include "exec/error.hpp"
#include "fdem3/elements/tetrahedra.hpp"
#include "fdem3/setup/mesh_faces.hpp"

namespace breccia::fdem3 {
namespace {

/// The part that a region takes, with its names looked up once.
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
    if (config.faces.empty()) return;
    const auto found =
        std::find_if(model.face_sets.begin(), model.face_sets.end(),
                     [&](const Model::FaceSet& s) { return s.name == config.faces; });
    if (found == model.face_sets.end()) {
      std::string known;
      for (const Model::FaceSet& s : model.face_sets) known += (known.empty() ? "" : ", ") + s.name;
      throw InputError(
          where + ".faces = \"" + config.faces +
          "\" is no surface of a mesh; there are: " + (known.empty() ? "none" : known));
    }
    for (const auto& face : found->faces) {
      faces_.insert(face);
      on_faces_.insert(face.begin(), face.end());
    }
  }

  bool takes(std::size_t tetrahedron, Index vertex) const {
    if (group_ >= 0 && model_.group[tetrahedron] != group_) return false;
    if (!config_.faces.empty() && on_faces_.count(vertex) == 0) return false;
    const Vec3& x = model_.point[static_cast<std::size_t>(vertex)];
    const Vec3 &low = config_.min, &high = config_.max;
    bool inside = x.x >= low.x && x.y >= low.y && x.z >= low.z && x.x <= high.x && x.y <= high.y &&
                  x.z <= high.z;
    if (config_.radius > 0.0)
      inside = inside && in_round(config_.center, config_.radius, config_.around, x);
    return inside != config_.outside;
  }
  bool takes_face(const std::array<Index, 3>& corners) const {
    return config_.faces.empty() || faces_.count(corners) != 0;
  }

 private:
  const Model& model_;
  const RegionConfig& config_;
  std::int16_t group_ = -1;
  std::set<std::array<Index, 3>> faces_;
  std::set<Index> on_faces_;
};

}  // namespace

std::vector<Index> corners_in(const Model& model, const RegionConfig& config,
                              const std::string& where) {
  const Region region(model, config, where);
  std::vector<Index> corners;
  for (std::size_t t = 0; t < model.tetrahedron.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k)
      if (region.takes(t, model.tetrahedron[t][k]))
        corners.push_back(static_cast<Index>(4 * t + k));
  if (corners.empty()) throw InputError(where + ": its region holds no corner of any tetrahedron");
  return corners;
}

std::vector<Index> faces_in(const Model& model, const RegionConfig& config,
                            const std::string& where) {
  const Region region(model, config, where);
  std::vector<Index> faces;
  for (const MeshFace& f : mesh_faces(model)) {
    if (f.b >= 0 || !region.takes_face(f.corners)) continue;
    const auto t = static_cast<std::size_t>(f.a / 4);
    if (std::all_of(f.corners.begin(), f.corners.end(),
                    [&](Index vertex) { return region.takes(t, vertex); }))
      faces.push_back(f.a);
  }
  if (faces.empty()) throw InputError(where + ": its region holds no face on the border");
  return faces;
}

}  // namespace breccia::fdem3
