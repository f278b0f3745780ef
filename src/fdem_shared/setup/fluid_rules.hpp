#pragma once
// Rules of loads that are fluids.

#include <string>
#include <vector>

namespace breccia::fdem_shared {

/// The first load of a case that is a fluid that flows; empty: none.
template <class Config>
std::string first_flow(const Config& config) {
  for (const auto& l : config.loads)
    if (l.flows()) return l.name;
  return {};
}

/// Fluids, and keys that only they have.
template <class Config>
void check_fluids(const Config& config, std::vector<std::string>& problems) {
  for (const auto& l : config.loads)
    if (l.speed > 0.0 && l.kind != "fluid")
      problems.push_back("load." + l.name + ".speed: only a fluid has one; kind is \"" + l.kind +
                         "\"");
  int flows = 0;
  for (const auto& l : config.loads) {
    const std::string where = "load." + l.name;
    const bool has_rate = l.rate.is_table() || l.rate.value != 0.0;
    const bool has_pressure = l.pressure.is_table() || l.pressure.value != 0.0;
    if (l.viscosity > 0.0 && l.kind != "fluid")
      problems.push_back(where + ".viscosity: only a fluid has one; kind is \"" + l.kind + "\"");
    if (has_rate && !l.flows())
      problems.push_back(where + ".rate: needs kind = \"fluid\" and a viscosity above 0");
    if (!l.outlets.empty() && !l.flows())
      problems.push_back(where + ".outlet: needs kind = \"fluid\" and a viscosity above 0");
    if (l.outlets.size() > 1) problems.push_back(where + ".outlet: one at most");
    if (!l.flows()) continue;
    if (has_rate && has_pressure)
      problems.push_back(where + ": give a rate or a pressure; a fluid takes one of them");
    if (l.speed > 0.0)
      problems.push_back(where + ".speed: a fluid with a viscosity runs as fast as it flows");
    if (++flows == 2)
      problems.push_back(where + ".viscosity: one fluid of a case may flow, and load." +
                         first_flow(config) + " does; its region may hold several places");
  }
  for (const auto& l : config.loads)
    if (flows > 0 && l.kind == "fluid" && !l.flows())
      problems.push_back("load." + l.name + ".kind: a fluid that flows, as load." +
                         first_flow(config) + ", is the only fluid of a case");
}

}  // namespace breccia::fdem_shared
