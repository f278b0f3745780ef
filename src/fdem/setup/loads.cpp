#include "fdem/setup/loads.hpp"

#include <algorithm>
#include <iterator>

#include "exec/error.hpp"
#include "fdem/fluid/cavity.hpp"
#include "fdem/fluid/fluid.hpp"
#include "fdem/setup/bolts.hpp"
#include "fdem/setup/regions.hpp"

namespace breccia::fdem {
namespace {

void prescribe_flow(FlowCase& flow, const LoadConfig& load) {
  flow.by_rate = load.rate.is_table() || load.rate.value != 0.0;
  const OverTime<double>& input = flow.by_rate ? load.rate : load.pressure;
  flow.input = {input.is_table() ? 1.0 : input.value,
                fdem_shared::amplitudes<Vec2>(input, load.history).x};
}

/// Sets the constants of a flowing fluid: viscosity, apertures, where it enters and leaves.
void set_up_flow(World& w, const Config& config, const LoadConfig& load, const Model& model) {
  FlowCase& flow = set_up(w).flow;
  flow.on = true;
  flow.triangles = model.size();
  flow.viscosity = load.viscosity;
  flow.bulk = load.bulk;
  flow.aperture = load.aperture;
  flow.filled = load.filled;
  flow.load = static_cast<std::int16_t>(&load - config.loads.data());
  flow.vertices = vertices_in(model, load.region, "load." + load.name);
  std::sort(flow.vertices.begin(), flow.vertices.end());
  for (const OutletConfig& outlet : load.outlets) {
    flow.outlet = vertices_in(model, outlet.region, "load." + load.name + ".outlet");
    std::sort(flow.outlet.begin(), flow.outlet.end());
    flow.outlet_pressure = outlet.pressure;
    std::vector<Index> both;
    std::set_intersection(flow.vertices.begin(), flow.vertices.end(), flow.outlet.begin(),
                          flow.outlet.end(), std::back_inserter(both));
    if (!both.empty())
      throw InputError("load." + load.name +
                       ".outlet: it shares vertices with the region where the fluid comes in");
  }
  std::vector<JointBond> bonds;
  copy_to(bonds, w.given->bonds);
  flow.stiffness = 1e300;
  for (const JointBond& bond : bonds) flow.stiffness = std::min(flow.stiffness, bond.stiffness);
  for (const MaterialConfig& m : config.materials)
    if (bonds.empty()) flow.stiffness = std::min(flow.stiffness, m.young);
}

/// Lets the source that was added last be the gas of an explosive.
void set_up_gas(World& w, const LoadConfig& load, const Model& model,
                const std::vector<Index>& edges, const std::vector<LoadedEdge>& borders) {
  FluidSource& source = set_up(w).fluids.back();
  const ExplosiveConfig& x = load.explosive;
  source.holes = holes_along(model, edges, "load." + load.name);
  source.borders = borders;
  source.law = ExplosiveGas::of(x.a, x.b, x.r1, x.r2, x.omega, x.energy);
  source.charge = x.charge > 0.0 ? x.charge : gas_volume(w, source);
}

}  // namespace

void prescribe_loads(World& w, const Config& asked) {
  Config config = asked;
  for (LoadConfig& load : config.loads)
    if (load.is_gas()) load.pressure = 1.0;  // times that of its volume
  fdem_shared::prescribe_loads(w, config);
  Case& given = set_up(w);
  for (std::size_t i = 0; i < config.loads.size(); ++i) {
    if (!config.loads[i].flows()) continue;
    prescribe_flow(given.flow, config.loads[i]);  // each edge has a pressure of its own
    given.loads[i] = {LoadKind::fluid, {1.0, 1.0}, 1.0, {}, {}};
    given.load_amplitudes[i] = {};
  }
  if (config.bolts.empty()) return;
  given.loads.push_back({LoadKind::bolt, {1.0, 1.0}, 1.0, {}, {}});  // the last one
  given.load_amplitudes.emplace_back();
}

void set_up_loads(World& w, const Config& config, const Model& model) {
  std::vector<LoadedEdge> loaded;
  std::vector<EdgeDashpots> dashpots;
  prescribe_loads(w, config);
  set_up_bolts(w, config, model);
  for (const LoadConfig& load : config.loads) {
    const auto index = static_cast<std::int16_t>(&load - config.loads.data());
    const LoadKind kind = w.given->loads[at(index)].kind;
    if (kind == LoadKind::absorbing) dashpots.resize(model.triangle.size());
    const std::size_t first = loaded.size();
    double length = 0.0;
    if (load.flows()) set_up_flow(w, config, load, model);
    if (kind == LoadKind::fluid)
      set_up(w).fluids.push_back(
          {index, load.speed, vertices_in(model, load.region, "load." + load.name)});
    const std::vector<Index> edges =
        edges_in(model, load.region, "load." + load.name, kind != LoadKind::fluid || load.is_gas());
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
      set_up_gas(w, load, model, edges, borders);
  }
  if (loaded.empty() && w.given->fluids.empty() && w.given->bolts.empty()) return;
  std::stable_sort(loaded.begin(), loaded.end(), [](const LoadedEdge& a, const LoadedEdge& b) {
    return a.triangle < b.triangle;
  });
  set_up(w).loaded = std::move(loaded);
  spread_fluid(w);
  list_loaded_edges(w);
  copy_to(w.dashpots, dashpots);
  w.triangles.external.resize(w.triangles.size());
}

}  // namespace breccia::fdem
