#pragma once
// Constants of fluids that flow through cracks.

#include <algorithm>
#include <iterator>

#include "exec/error.hpp"
#include "fdem_shared/setup/over_time.hpp"

namespace breccia::fdem_shared {

/// How large loads are, and how that changes: what configure() writes anew. Of a fluid that flows
/// each side has a pressure of its own.
template <class World, class Config>
void prescribe_loads_and_flow(World& w, const Config& config) {
  using Vector = typename ShapeOf<World>::Vector;
  fdem_shared::prescribe_loads(w, config);
  auto& given = set_up(w);
  for (std::size_t i = 0; i < config.loads.size(); ++i) {
    const auto& load = config.loads[i];
    if (!load.flows()) continue;
    given.flow.by_rate = load.rate.is_table() || load.rate.value != 0.0;
    const OverTime<double>& input = given.flow.by_rate ? load.rate : load.pressure;
    given.flow.input = {input.is_table() ? 1.0 : input.value,
                        amplitudes<Vector>(input, load.history).x};
    given.loads[i] = {LoadKind::fluid, from_space<Vector>({1.0, 1.0, 1.0}), 1.0, {}, {}};
    given.load_amplitudes[i] = {};
  }
}

/// Viscosity, apertures, where a fluid that flows enters and leaves.
/// @param ports_in  ports_in(region, where): those of a region, ascending
template <class World, class Config, class Load, class Model, class PortsIn>
void set_up_flow(World& w, const Config& config, const Load& load, const Model& model,
                 const PortsIn& ports_in) {
  auto& flow = set_up(w).flow;
  flow.on = true;
  flow.elements = model.size();
  flow.viscosity = load.viscosity;
  flow.bulk = load.bulk;
  flow.aperture = load.aperture;
  flow.filled = load.filled;
  flow.load = static_cast<std::int16_t>(&load - config.loads.data());
  flow.ports = ports_in(load.region, "load." + load.name);
  for (const auto& outlet : load.outlets) {
    flow.outlet = ports_in(outlet.region, "load." + load.name + ".outlet");
    flow.outlet_pressure = outlet.pressure;
    std::vector<Port> both;
    std::set_intersection(flow.ports.begin(), flow.ports.end(), flow.outlet.begin(),
                          flow.outlet.end(), std::back_inserter(both));
    if (!both.empty())
      throw InputError("load." + load.name + ".outlet: it shares " + ShapeOf<World>::port_words +
                       " with the region where the fluid comes in");
  }
  std::vector<std::remove_cvref_t<decltype(*w.given->bonds.data())>> bonds;
  copy_to(bonds, w.given->bonds);
  flow.stiffness = 1e300;
  for (const auto& bond : bonds) flow.stiffness = std::min(flow.stiffness, bond.stiffness);
  for (const auto& m : config.materials)
    if (bonds.empty()) flow.stiffness = std::min(flow.stiffness, m.young);
}

}  // namespace breccia::fdem_shared
