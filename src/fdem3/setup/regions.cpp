#include "fdem3/setup/regions.hpp"

#include "fdem3/setup/mesh_faces.hpp"
#include "fdem3/shape.hpp"
#include "fdem_shared/setup/regions.hpp"

namespace breccia::fdem3 {

std::vector<Index> corners_in(const Model& model, const RegionConfig& config,
                              const std::string& where) {
  return fdem_shared::corners_within<Shape>(model, config, where);
}

std::vector<Index> faces_in(const Model& model, const RegionConfig& config,
                            const std::string& where) {
  const fdem_shared::Region<Shape, Model, RegionConfig> region(model, config, where);
  std::vector<Index> faces;
  for (const MeshFace& f : mesh_faces(model))
    if (f.b < 0 && region.takes_side(at(f.a / 4), f.corners)) faces.push_back(f.a);
  if (faces.empty()) throw InputError(where + ": its region holds no face on the border");
  return faces;
}

}  // namespace breccia::fdem3
