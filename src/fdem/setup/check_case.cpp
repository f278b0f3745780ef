#include "fdem/setup/check_case.hpp"

#include "core/probe.hpp"
#include "exec/error.hpp"
#include "fdem/setup/bolts.hpp"
#include "fdem/setup/case_rules.hpp"
#include "fdem/setup/materials.hpp"
#include "fdem/setup/stages.hpp"
#include "fdem_shared/setup/bolts.hpp"
#include "fdem_shared/setup/explosives.hpp"
#include "fdem_shared/setup/fluid_rules.hpp"

namespace breccia::fdem {

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
  fdem_shared::check_gas(config, problems);
  for (const std::string& problem : bolt_problems(config)) add(problem);
  fdem_shared::add_probe_problems(config, in_plane, 2, problems);
  for (const std::string& problem : stage_problems(config)) add(problem);
  return problems;
}

}  // namespace breccia::fdem
