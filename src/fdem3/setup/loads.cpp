#include "fdem3/setup/loads.hpp"

#include <algorithm>

#include "fdem3/setup/regions.hpp"
#include "fdem3/setup/writable.hpp"

namespace breccia::fdem3 {
namespace {

LoadKind kind_of(const LoadConfig& load) {
  if (load.kind == "pressure") return LoadKind::pressure;
  if (load.kind == "traction") return LoadKind::traction;
  return load.kind == "force" ? LoadKind::force : LoadKind::absorbing;
}

/// How a load changes over time, by the quantity that its kind asks for.
AmplitudeOf3 load_amplitude(const LoadConfig& load, LoadKind kind) {
  if (kind == LoadKind::traction) return amplitude(load.traction, load.history);
  if (kind == LoadKind::force) return amplitude(load.force, load.history);
  return amplitude(kind == LoadKind::absorbing ? OverTime<double>(1.0) : load.pressure,
                   load.history);
}

double area_of(const Model& model, Index face) {
  const auto& corners = model.tetrahedron[at(face / 4)];
  const auto point = [&](int k) {
    return model.point[at(corners[at(corner_of_face(face % 4, k))])];
  };
  return 0.5 * norm(cross(point(1) - point(0), point(2) - point(0)));
}

}  // namespace

void prescribe_loads(World& w, const Config& config) {
  Case& given = set_up(w);
  given.loads.clear();
  given.load_amplitudes.clear();
  given.load_names.clear();
  for (const LoadConfig& load : config.loads) {
    const LoadKind kind = kind_of(load);
    given.load_names.push_back(load.name);
    given.loads.push_back({kind,
                           {1.0, 1.0, 1.0},
                           load.pressure.is_table() ? 1.0 : load.pressure.value,
                           scale_of(load.traction),
                           scale_of(load.force)});
    given.load_amplitudes.push_back(load_amplitude(load, kind));
  }
}

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
  std::vector<GlobalId> ids;
  copy_to(ids, w.tetrahedra.id);
  std::vector<Index> starts{0};
  std::vector<LoadedFace> here;
  for (const LoadedFace& face : w.given->loaded) {
    const auto found = std::lower_bound(ids.begin(), ids.end(), face.tetrahedron);
    if (found == ids.end() || *found != face.tetrahedron) continue;
    const auto place = static_cast<Index>(found - ids.begin());
    if (!here.empty() && here.back().tetrahedron != place)
      starts.push_back(static_cast<Index>(here.size()));
    here.push_back(face);
    here.back().tetrahedron = place;
  }
  if (!here.empty()) starts.push_back(static_cast<Index>(here.size()));
  copy_to(w.load_starts, starts);
  copy_to(w.loaded_faces, here);
}

}  // namespace breccia::fdem3
