#include "fdem/setup/stages.hpp"

#include <algorithm>

#include "core/named.hpp"

namespace breccia::fdem {

Config config_at(Config config, const StageProgress& progress) {
  for (std::size_t k = 0; k < config.stages.size() && k <= static_cast<std::size_t>(progress.index);
       ++k) {
    const StageConfig& stage = config.stages[k];
    const double begin = progress.begin[k];
    config.removed.insert(config.removed.end(), stage.remove.begin(), stage.remove.end());
    if (stage.local_damping >= 0.0) config.local_damping = stage.local_damping;
    if (stage.friction >= 0.0) config.stage_friction = stage.friction;
    if (stage.gravity.x < no_limit) config.gravity = stage.gravity;
    for (const SupportChange& change : stage.supports)
      if (SupportConfig* const s = find_named(config.supports, change.name)) {
        if (change.fix != std::vector<std::string>{"same"}) s->fix = change.fix;
        s->velocity = change.velocity;
        s->history = {change.ramp, {}, {}, begin};
        s->servo = change.servo;
      }
    for (const MaterialChange& change : stage.materials)
      if (MaterialConfig* const m = find_named(config.materials, change.name)) {
        if (change.young > 0.0) m->young_now = change.young;
        if (change.in_situ >= 0.0) m->in_situ_share = change.in_situ;
        if (change.friction >= 0.0) m->friction = change.friction;
      }
    for (const LoadChange& change : stage.loads)
      if (LoadConfig* const load = find_named(config.loads, change.name)) {
        load->pressure = change.pressure;
        load->traction = change.traction;
        load->force = change.force;
        load->rate = change.rate;
        load->history = {change.ramp, {}, {}, begin};
      }
  }
  return config;
}

std::vector<std::string> stage_problems(const Config& config) {
  std::vector<std::string> problems =
      breccia::stage_problems({config.stages.begin(), config.stages.end()},
                              breccia::names_of(config.probes), breccia::names_of(config.bodies));
  const std::vector<std::string> supports = breccia::names_of(config.supports);
  const std::vector<std::string> loads = breccia::names_of(config.loads);
  for (const StageConfig& stage : config.stages) {
    const std::string where = "stage." + stage.name;
    for (const SupportChange& change : stage.supports) {
      add_unknown(where + ".support.name", change.name, "support", supports, problems);
      for (const std::string& word : change.fix)
        if (word != "x" && word != "y" && word != "same")
          problems.push_back(where + ".support." + change.name + ".fix: \"" + word +
                             "\" is no direction; allowed: x, y");
    }
    for (const MaterialChange& change : stage.materials)
      add_unknown(where + ".material.name", change.name, "material", names_of(config.materials),
                  problems);
    for (const LoadChange& change : stage.loads) {
      add_unknown(where + ".load.name", change.name, "load", loads, problems);
      for (const LoadConfig& load : config.loads)
        if (load.name == change.name && load.kind == "absorbing")
          problems.push_back(where + ".load." + change.name + " is absorbing, and has no size");
    }
  }
  StageProgress progress;
  for (std::size_t k = 0; k < std::max<std::size_t>(config.stages.size(), 1); ++k) {
    progress.index = static_cast<std::int32_t>(k);
    const std::string stage = config.stages.empty() ? "" : "stage." + config.stages[k].name + ": ";
    for (const SupportConfig& s : config_at(config, progress).supports) {
      if (!s.servo.is_on()) continue;
      const std::string where = stage + "support." + s.name;
      if (s.velocity.is_table() || norm(s.velocity.value) > 0.0)
        problems.push_back(where + ": it has a velocity and a servo, which decides that");
      if ((s.servo.pressure.is_table() || s.servo.pressure.value != 0.0) && !(s.servo.area > 0.0))
        problems.push_back(where + ".servo.area: the pressure needs a length to act on");
      if (std::find(s.fix.begin(), s.fix.end(), s.servo.axis) == s.fix.end())
        problems.push_back(where + ".servo.axis = \"" + s.servo.axis +
                           "\": it does not fix that direction");
    }
  }
  std::sort(problems.begin(), problems.end());
  problems.erase(std::unique(problems.begin(), problems.end()), problems.end());
  return problems;
}

}  // namespace breccia::fdem
