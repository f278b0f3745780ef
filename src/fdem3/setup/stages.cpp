#include "fdem3/setup/stages.hpp"

#include "fdem_shared/setup/stages.hpp"

namespace breccia::fdem3 {

Config config_at(Config config, const StageProgress& progress) {
  for (std::size_t k = 0; k < config.stages.size() && k <= static_cast<std::size_t>(progress.index);
       ++k)
    fdem_shared::begin_stage(config, config.stages[k], progress.begin[k]);
  return config;
}

std::vector<std::string> stage_problems(const Config& config) {
  return fdem_shared::each_once(
      fdem_shared::problems_of_stages(config, {"x", "y", "z"}, "an area", config_at));
}

}  // namespace breccia::fdem3
