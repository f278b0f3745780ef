#pragma once
// Explosives of a case: keys, what is wrong with them, and the gas that they become.

#include <string>
#include <utility>
#include <vector>

#include "fdem_shared/setup/writable.hpp"

namespace breccia::fdem_shared {

/// Problems of explosives in a case.
template <class Config>
void check_gas(const Config& config, std::vector<std::string>& problems) {
  for (const auto& l : config.loads) {
    if (!l.is_gas()) continue;
    const std::string where = "load." + l.name + ".explosive";
    const auto& x = l.explosive;
    if (l.kind != "fluid")
      problems.push_back(where + ": needs kind = \"fluid\"; kind is \"" + l.kind + "\"");
    if (l.viscosity > 0.0)
      problems.push_back(where + ": a gas has one pressure; leave viscosity out");
    if (l.pressure.is_table() || l.pressure.value != 0.0)
      problems.push_back("load." + l.name +
                         ".pressure: that of an explosive follows from its volume; leave it out");
    if (x.gas().c < 0.0)
      problems.push_back(where + ".energy: A/R1 exp(-R1) + B/R2 exp(-R2) alone is more than it");
    for (const auto& stage : config.stages)
      for (const auto& change : stage.loads)
        if (change.name == l.name)
          problems.push_back(
              "stage." + stage.name + ".load." + l.name +
              ": the pressure of an explosive follows from its volume in all stages");
  }
}

/// A case whose gas has a pressure of 1, times that of its volume.
template <class Config>
Config with_gas_of_one(Config config) {
  for (auto& load : config.loads)
    if (load.is_gas()) load.pressure = 1.0;
  return config;
}

/// Lets the source that was added last be the gas of an explosive in these holes. The method says
/// how large they are: gas_volume(w, source), and notes their walls: note_walls(w, source).
template <class World, class Load, class Hole, class Side>
void set_up_gas(World& w, const Load& load, std::vector<Hole> holes,
                const std::vector<Side>& borders) {
  auto& source = set_up(w).fluids.back();
  source.holes = std::move(holes);
  source.borders = borders;
  source.law = load.explosive.gas();
  source.charge = load.explosive.charge > 0.0 ? load.explosive.charge : gas_volume(w, source);
  note_walls(w, source);
}

}  // namespace breccia::fdem_shared
