#include "fdem/setup/stages.hpp"

#include "fdem_shared/setup/stages.hpp"

namespace breccia::fdem {

Config config_at(Config config, const StageProgress& progress) {
  for (std::size_t k = 0; k < config.stages.size() && k <= static_cast<std::size_t>(progress.index);
       ++k) {
    const StageConfig& stage = config.stages[k];
    fdem_shared::begin_stage(config, stage, progress.begin[k]);
    if (stage.restitution > 0.0) config.contact.restitution = stage.restitution;
  }
  return config;
}

std::vector<std::string> stage_problems(const Config& config) {
  return fdem_shared::each_once(
      fdem_shared::problems_of_stages(config, {"x", "y"}, "a length", config_at));
}

}  // namespace breccia::fdem
