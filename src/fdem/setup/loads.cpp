#include "fdem/setup/loads.hpp"

#include <algorithm>

#include "fdem/fluid/cavity.hpp"
#include "fdem/fluid/fluid.hpp"
#include "fdem/setup/regions.hpp"
#include "fdem_shared/setup/bolts.hpp"
#include "fdem_shared/setup/explosives.hpp"
#include "fdem_shared/setup/fluids.hpp"

namespace breccia::fdem {

void prescribe_loads(World& w, const Config& config) {
  fdem_shared::prescribe_loads_and_flow(w, fdem_shared::with_gas_of_one(config));
  fdem_shared::prescribe_bolts(w, config);
}

void set_up_loads(World& w, const Config& config, const Model& model) {
  std::vector<LoadedEdge> loaded;
  std::vector<EdgeDashpots> dashpots;
  prescribe_loads(w, config);
  fdem_shared::set_up_bolts(w, config, model);
  const auto ports = [&](const RegionConfig& region, const std::string& where) {
    const std::vector<Index> vertices = vertices_in(model, region, where);
    return std::vector<fdem_shared::Port>(vertices.begin(), vertices.end());
  };
  for (const LoadConfig& load : config.loads) {
    const auto index = static_cast<std::int16_t>(&load - config.loads.data());
    const LoadKind kind = w.given->loads[at(index)].kind;
    if (kind == LoadKind::absorbing) dashpots.resize(model.triangle.size());
    const std::size_t first = loaded.size();
    double length = 0.0;
    if (load.flows()) fdem_shared::set_up_flow(w, config, load, model, ports);
    if (kind == LoadKind::fluid)
      set_up(w).fluids.push_back({{index, load.speed, ports(load.region, "load." + load.name)}});
    const std::vector<Index> edges =
        edges_in(model, load.region, "load." + load.name,
                 fdem_shared::laid_bare_by(config, load.dug_by, model.groups),
                 kind != LoadKind::fluid || load.is_gas());
    for (const Index edge : edges) {
      const auto t = at(edge / 3), k = at(edge % 3);
      const auto material = static_cast<std::size_t>(model.material[t]);
      const Vec2 line =
          model.point[at(model.triangle[t][(k + 1) % 3])] - model.point[at(model.triangle[t][k])];
      const double own = norm(line);
      const EffectiveRock::Impedances met = w.given->rocks[material].across(line);
      loaded.push_back(
          {edge / 3, static_cast<std::int16_t>(k), index, own, met.pressing, met.shearing});
      length += own;
      if (kind == LoadKind::absorbing)
        dashpots[t].at[k] +=
            std::max(met.pressing, met.shearing) * w.given->load_amplitudes[at(index)].x.largest();
    }
    for (std::size_t i = first; i < loaded.size(); ++i)
      loaded[i].share = kind == LoadKind::fluid ? 1.0 : loaded[i].share / length;
    if (!load.flows() && !load.is_gas()) continue;
    const std::vector<LoadedEdge> borders(loaded.begin() + static_cast<std::ptrdiff_t>(first),
                                          loaded.end());
    loaded.resize(first);
    if (load.flows())
      set_up(w).flow.borders = borders;
    else
      fdem_shared::set_up_gas(w, load, holes_along(model, edges, "load." + load.name), borders);
  }
  if (loaded.empty() && w.given->fluids.empty() && w.given->bolts.empty()) return;
  std::stable_sort(loaded.begin(), loaded.end(), [](const LoadedEdge& a, const LoadedEdge& b) {
    return a.triangle < b.triangle;
  });
  set_up(w).loaded = std::move(loaded);
  spread_fluid(w);
  list_loaded(w);
  copy_to(w.dashpots, dashpots);
  w.triangles.external.resize(w.triangles.size());
}

}  // namespace breccia::fdem
