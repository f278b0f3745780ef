#include "fdem3/setup/regions.hpp"

#include "fdem3/setup/mesh_faces.hpp"
#include "fdem3/shape.hpp"
#include "fdem_shared/setup/regions.hpp"

namespace breccia::fdem3 {

std::vector<Index> corners_in(const Model& model, const RegionConfig& config,
                              const std::string& where) {
  return fdem_shared::corners_within<Shape>(model, config, where);
}

std::vector<Index> faces_in(const Model& model, const std::vector<Index>& across,
                            const RegionConfig& config, const std::string& where,
                            const fdem_shared::LaidBare& bare, bool needed) {
  const fdem_shared::Region<Shape, Model, RegionConfig> region(model, config, where);
  const auto group = [&](Index face) { return at(model.group[at(face / 4)]); };
  std::vector<Index> faces;
  each_face(model, across, [&](const MeshFace& f) {
    const Index own = bare.side(f.a, f.b, group);
    if (own >= 0 && region.takes_side(at(own / 4), f.corners)) faces.push_back(own);
  });
  if (faces.empty() && needed) throw InputError(bare.none_of(where, "face"));
  return faces;
}

std::vector<fdem_shared::Port> ports_in(const Model& model, const RegionConfig& config,
                                        const std::string& where) {
  corners_in(model, config, where);
  const fdem_shared::Region<Shape, Model, RegionConfig> region(model, config, where);
  std::vector<fdem_shared::Port> ports;
  for (std::size_t t = 0; t < model.tetrahedron.size(); ++t) {
    const auto& corner = model.tetrahedron[t];
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (region.takes(t, corner[i]) && region.takes(t, corner[k]))
          ports.push_back(fdem_shared::port_between(corner[i], corner[k]));
  }
  if (ports.empty())
    throw InputError(where +
                     ": its region holds corners, but no edge of any tetrahedron, through which a "
                     "fluid comes; let it hold both ends of one");
  std::sort(ports.begin(), ports.end());
  ports.erase(std::unique(ports.begin(), ports.end()), ports.end());
  return ports;
}

}  // namespace breccia::fdem3
