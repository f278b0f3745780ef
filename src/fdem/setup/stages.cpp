#include "fdem/setup/stages.hpp"

#include "fdem_shared/setup/stages.hpp"

namespace breccia::fdem {

Config config_at(Config config, const StageProgress& progress) {
  for (std::size_t k = 0; k < config.stages.size() && k <= static_cast<std::size_t>(progress.index);
       ++k) {
    const StageConfig& stage = config.stages[k];
    config.removed.insert(config.removed.end(), stage.remove.begin(), stage.remove.end());
    fdem_shared::begin_stage(config, stage, progress.begin[k]);
    for (const LoadChange& change : stage.loads)
      if (LoadConfig* const load = find_named(config.loads, change.name)) load->rate = change.rate;
    for (const MaterialChange& change : stage.materials)
      if (MaterialConfig* const m = find_named(config.materials, change.name)) {
        if (change.young > 0.0) m->young_now = change.young;
        if (change.in_situ >= 0.0) m->in_situ_share = change.in_situ;
        if (change.friction >= 0.0) m->friction = change.friction;
      }
  }
  return config;
}

std::vector<std::string> stage_problems(const Config& config) {
  std::vector<std::string> problems =
      fdem_shared::problems_of_stages(config, {"x", "y"}, "a length", config_at);
  for (const StageConfig& stage : config.stages)
    for (const MaterialChange& change : stage.materials)
      add_unknown("stage." + stage.name + ".material.name", change.name, "material",
                  names_of(config.materials), problems);
  return fdem_shared::each_once(std::move(problems));
}

}  // namespace breccia::fdem
