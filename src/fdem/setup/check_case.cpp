#include "fdem/setup/check_case.hpp"

#include "core/probe.hpp"
#include "exec/error.hpp"
#include "fdem/setup/case_rules.hpp"
#include "fdem/setup/stages.hpp"

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
  for (const LoadConfig& l : config.loads)
    if (l.speed > 0.0 && l.kind != "fluid")
      add("load." + l.name + ".speed: only a fluid has one; kind is \"" + l.kind + "\"");
  for (const ProbeConfig& p : config.probes)
    for (const std::string& problem : probe_problems(p, in_plane)) add(problem);
  for (const std::string& problem : stage_problems(config)) add(problem);
  return problems;
}

}  // namespace breccia::fdem
