#include "fdem3/setup/loads.hpp"

#include <algorithm>

#include "fdem3/fluid/cavity.hpp"
#include "fdem3/fluid/fluid.hpp"
#include "fdem3/setup/regions.hpp"
#include "fdem_shared/setup/bolts.hpp"
#include "fdem_shared/setup/explosives.hpp"
#include "fdem_shared/setup/fluids.hpp"

namespace breccia::fdem3 {
namespace {

/// Normal of a face, as long as its area.  [m2]
Vec3 area_of(const Model& model, Index face) {
  const auto& corners = model.tetrahedron[at(face / 4)];
  const auto point = [&](int k) {
    return model.point[at(corners[at(corner_of_face(face % 4, k))])];
  };
  return 0.5 * cross(point(1) - point(0), point(2) - point(0));
}

}  // namespace

void prescribe_loads(World& w, const Config& config) {
  fdem_shared::prescribe_loads_and_flow(w, fdem_shared::with_gas_of_one(config));
  fdem_shared::prescribe_bolts(w, config);
}

void set_up_loads(World& w, const Config& config, const Model& model) {
  std::vector<LoadedFace> loaded;
  std::vector<FaceDashpots> dashpots;
  prescribe_loads(w, config);
  fdem_shared::set_up_bolts(w, config, model);
  const auto ports = [&](const RegionConfig& region, const std::string& where) {
    return ports_in(model, region, where);
  };
  for (std::size_t l = 0; l < config.loads.size(); ++l) {
    const LoadConfig& load = config.loads[l];
    const LoadKind kind = w.given->loads[l].kind;
    const bool absorbs = kind == LoadKind::absorbing, is_fluid = kind == LoadKind::fluid;
    if (absorbs) dashpots.resize(model.tetrahedron.size());
    const std::size_t first = loaded.size();
    double area = 0.0;
    if (load.flows()) fdem_shared::set_up_flow(w, config, load, model, ports);
    if (is_fluid)
      set_up(w).fluids.push_back(
          {{static_cast<std::int16_t>(l), load.speed, ports(load.region, "load." + load.name)}});
    const std::vector<Index> faces = faces_in(
        model, w.across, load.region, "load." + load.name,
        fdem_shared::laid_bare_by(config, load.dug_by, model.groups), !is_fluid || load.is_gas());
    for (const Index face : faces) {
      const auto t = at(face / 4);
      const auto material = static_cast<std::size_t>(model.material[t]);
      const Vec3 normal = area_of(model, face);
      const double own = norm(normal);
      const EffectiveRock::Impedances met = w.given->rocks[material].on(normal);
      loaded.push_back({face / 4, static_cast<std::int16_t>(face % 4), static_cast<std::int16_t>(l),
                        own, met.pressing, met.shearing});
      area += own;
      if (absorbs)
        dashpots[t].at[face % 4] +=
            std::max(met.pressing, met.shearing) * w.given->load_amplitudes[l].x.largest();
    }
    for (std::size_t i = first; i < loaded.size(); ++i)
      loaded[i].share = is_fluid ? 1.0 : loaded[i].share / area;
    if (!load.flows() && !load.is_gas()) continue;
    const std::vector<LoadedFace> borders(loaded.begin() + static_cast<std::ptrdiff_t>(first),
                                          loaded.end());
    loaded.resize(first);
    if (load.flows())
      set_up(w).flow.borders = borders;
    else
      fdem_shared::set_up_gas(
          w, load, holes_along(model, faces, load.explosive.capped, "load." + load.name), borders);
  }
  if (loaded.empty() && w.given->fluids.empty() && w.given->bolts.empty()) return;
  std::stable_sort(loaded.begin(), loaded.end(), [](const LoadedFace& a, const LoadedFace& b) {
    return a.tetrahedron < b.tetrahedron;
  });
  set_up(w).loaded = std::move(loaded);
  spread_fluid(w);
  list_loaded(w);
  copy_to(w.dashpots, dashpots);
  w.tetrahedra.external.resize(w.tetrahedra.size());
}

}  // namespace breccia::fdem3
