#include "fdem/setup/check_case.hpp"

#include "core/probe.hpp"
#include "exec/error.hpp"
#include "fdem/laws/explosive.hpp"
#include "fdem/setup/bolts.hpp"
#include "fdem/setup/case_rules.hpp"
#include "fdem/setup/stages.hpp"

namespace breccia::fdem {
namespace {

std::string first_flow(const Config& config) {
  for (const LoadConfig& l : config.loads)
    if (l.flows()) return l.name;
  return {};
}

/// Explosives: gas in holes.
void check_gas(const Config& config, std::vector<std::string>& problems) {
  for (const LoadConfig& l : config.loads) {
    if (!l.is_gas()) continue;
    const std::string where = "load." + l.name + ".explosive";
    const ExplosiveConfig& x = l.explosive;
    if (l.kind != "fluid")
      problems.push_back(where + ": needs kind = \"fluid\"; kind is \"" + l.kind + "\"");
    if (l.viscosity > 0.0)
      problems.push_back(where + ": a gas has one pressure; leave viscosity out");
    if (l.pressure.is_table() || l.pressure.value != 0.0)
      problems.push_back("load." + l.name +
                         ".pressure: that of an explosive follows from its volume; leave it out");
    if (ExplosiveGas::of(x.a, x.b, x.r1, x.r2, x.omega, x.energy).c < 0.0)
      problems.push_back(where + ".energy: A/R1 exp(-R1) + B/R2 exp(-R2) alone is more than it");
    for (const StageConfig& stage : config.stages)
      for (const LoadChange& change : stage.loads)
        if (change.name == l.name)
          problems.push_back(
              "stage." + stage.name + ".load." + l.name +
              ": the pressure of an explosive follows from its volume in all stages");
  }
}

/// Fluids that flow, and keys that only they have.
void check_flows(const Config& config, std::vector<std::string>& problems) {
  int flows = 0;
  for (const LoadConfig& l : config.loads) {
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
  for (const LoadConfig& l : config.loads)
    if (flows > 0 && l.kind == "fluid" && !l.flows())
      problems.push_back("load." + l.name + ".kind: a fluid that flows, as load." +
                         first_flow(config) + ", is the only fluid of a case");
}

}  // namespace

std::vector<std::string> case_problems(const Config& config) {
  const std::vector<std::string> directions{"x", "y"};
  std::vector<std::string> problems = CaseRules<Config>(config, config, directions).problems;
  const auto add = [&](const std::string& text) { problems.push_back(text); };
  try {
    elastic_table(config);
  } catch (const InputError& error) {
    add(error.what());
  }
  for (const MaterialConfig& m : config.materials)
    if (norm(m.bedding.normal) > 0.0)
      add("material." + m.name +
          ".bedding.normal is of tetrahedra; angle tells planes of triangles");
  for (const LoadConfig& l : config.loads)
    if (l.speed > 0.0 && l.kind != "fluid")
      add("load." + l.name + ".speed: only a fluid has one; kind is \"" + l.kind + "\"");
  check_flows(config, problems);
  check_gas(config, problems);
  for (const std::string& problem : bolt_problems(config)) add(problem);
  for (const ProbeConfig& p : config.probes) {
    const auto reads = [&](const BoltConfig& bolt) { return bolt.name == p.on; };
    const bool bolt = std::any_of(config.bolts.begin(), config.bolts.end(), reads);
    for (const std::string& problem : probe_problems(p, bolt ? of_bolt : in_plane)) add(problem);
  }
  for (const std::string& problem : stage_problems(config)) add(problem);
  return problems;
}

}  // namespace breccia::fdem
