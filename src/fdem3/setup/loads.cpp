#include "fdem3/setup/loads.hpp"

#include <algorithm>

#include "fdem3/setup/regions.hpp"
#include "fdem_shared/loaded_sides.hpp"

namespace breccia::fdem3 {
namespace {

double area_of(const Model& model, Index face) {
  const auto& corners = model.tetrahedron[at(face / 4)];
  const auto point = [&](int k) {
    return model.point[at(corners[at(corner_of_face(face % 4, k))])];
  };
  return 0.5 * norm(cross(point(1) - point(0), point(2) - point(0)));
}

}  // namespace

void set_up_loads(World& w, const Config& config, const Model& model) {
  std::vector<LoadedFace> loaded;
  std::vector<FaceDashpots> dashpots;
  prescribe_loads(w, config);
  for (std::size_t l = 0; l < config.loads.size(); ++l) {
    const LoadConfig& load = config.loads[l];
    const bool absorbs = w.given->loads[l].kind == LoadKind::absorbing;
    if (absorbs) dashpots.resize(model.tetrahedron.size());
    const std::size_t first = loaded.size();
    double area = 0.0;
    for (const Index face : faces_in(model, load.region, "load." + load.name)) {
      const auto t = at(face / 4);
      const auto material = static_cast<std::size_t>(model.material[t]);
      const double density = config.materials[material].density;
      const double own = area_of(model, face), impedance = density * w.given->rocks[material].fast;
      loaded.push_back({face / 4, static_cast<std::int16_t>(face % 4), static_cast<std::int16_t>(l),
                        own, impedance, density * w.given->rocks[material].slow});
      area += own;
      if (absorbs) dashpots[t].at[face % 4] += impedance * w.given->load_amplitudes[l].x.largest();
    }
    for (std::size_t i = first; i < loaded.size(); ++i) loaded[i].share /= area;
  }
  if (loaded.empty()) return;
  std::stable_sort(loaded.begin(), loaded.end(), [](const LoadedFace& a, const LoadedFace& b) {
    return a.tetrahedron < b.tetrahedron;
  });
  set_up(w).loaded = std::move(loaded);
  list_loaded_faces(w);
  copy_to(w.dashpots, dashpots);
  w.tetrahedra.external.resize(w.tetrahedra.size());
}

void list_loaded_faces(World& w) {
  if (w.given->loaded.empty()) return;
  const auto here = fdem_shared::loaded_here(
      w.given->loaded, w.tetrahedra.id, [](auto& face) -> auto& { return face.tetrahedron; });
  copy_to(w.load_starts, here.starts);
  copy_to(w.loaded_faces, here.sides);
}

}  // namespace breccia::fdem3
