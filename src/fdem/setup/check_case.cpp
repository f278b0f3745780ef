#include "fdem/setup/check_case.hpp"

#include "core/probe.hpp"
#include "exec/error.hpp"
#include "fdem/laws/explosive.hpp"
#include "fdem/setup/bolts.hpp"
#include "fdem/setup/case_rules.hpp"
#include "fdem/setup/stages.hpp"
#include "fdem_shared/setup/bolts.hpp"
#include "fdem_shared/setup/fluid_rules.hpp"

namespace breccia::fdem {
namespace {

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
  fdem_shared::check_fluids(config, problems);
  check_gas(config, problems);
  for (const std::string& problem : bolt_problems(config)) add(problem);
  fdem_shared::add_probe_problems(config, in_plane, 2, problems);
  for (const std::string& problem : stage_problems(config)) add(problem);
  return problems;
}

}  // namespace breccia::fdem
