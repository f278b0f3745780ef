#include "fdem/setup/check_case.hpp"

#include <algorithm>
#include <functional>
#include <set>

#include "core/probe.hpp"
#include "exec/error.hpp"
#include "fdem/setup/materials.hpp"
#include "fdem/setup/stages.hpp"

namespace breccia::fdem {
namespace {

template <class Config>
std::string names_of(const std::vector<Config>& configs) {
  std::string names;
  for (const Config& config : configs) names += (names.empty() ? "" : ", ") + config.name;
  return names.empty() ? "none" : names;
}

/// Minerals of which one breaks and one does not need a joint between them: grains would lie loose.
void look_for_loose_grains(const Config& config, const BodyConfig& body,
                           const std::function<void(const std::string&)>& add) {
  if (body.grains.kind.empty()) return;
  const auto breaks = [&](const std::string& name) {
    const auto m = std::find_if(config.materials.begin(), config.materials.end(),
                                [&](const MaterialConfig& each) { return each.name == name; });
    return m == config.materials.end() || m->joints != "none";
  };
  const auto joined = [&](const std::string& a, const std::string& b) {
    return std::any_of(config.joint_laws.begin(), config.joint_laws.end(), [&](const auto& j) {
      return j.between == std::vector{a, b} || j.between == std::vector{b, a};
    });
  };
  std::set<std::string> names;
  for (const MineralConfig& m : body.grains.minerals) names.insert(m.material);
  for (const std::string& firm : names)
    for (const std::string& weak : names)
      if (!breaks(firm) && breaks(weak) && !joined(firm, weak))
        add("body." + body.name + ".grains: nothing joins " + firm + " (joints = \"none\") and " +
            weak + "; a [joint.<name>] with between = [\"" + firm + "\", \"" + weak + "\"] does");
}

}  // namespace

std::vector<std::string> case_problems(const Config& config) {
  std::vector<std::string> problems;
  const auto add = [&](const std::string& text) { problems.push_back(text); };
  const auto attempt = [&](const std::function<void()>& part) {
    try {
      part();
    } catch (const InputError& error) {
      add(error.what());
    }
  };
  if (config.materials.empty()) add("material: at least one [material.<name>] is needed");
  attempt([&] { elastic_table(config); });
  attempt([&] { bond_table(config); });
  attempt([&] { contact_table(config); });
  std::set<std::string> places;
  for (const BodyConfig& b : config.bodies) places.insert(b.name);
  for (const SupportConfig& s : config.supports)
    if (!places.insert(s.name).second)
      add("support." + s.name + ": the name is taken by a body or support");
  const auto history = [&](const std::string& where, const HistoryConfig& h) {
    if (h.times.size() != h.factors.size()) add(where + ": times and factors must be equally many");
    if (!std::is_sorted(h.times.begin(), h.times.end(), std::less_equal<>()))
      add(where + ".times: must grow from one to the next");
  };
  const auto one_table = [&](const std::string& where, const auto& quantity,
                             const HistoryConfig& h) {
    if (quantity.is_table() && !h.times.empty())
      add(where + " is a table over time; times and factors would be a second one");
  };
  const auto look_up_body = [&](const std::string& where, const std::string& on) {
    if (!on.empty() && std::none_of(config.bodies.begin(), config.bodies.end(),
                                    [&](const BodyConfig& b) { return b.name == on; }))
      add(where + ".on = \"" + on + "\" is not a body; there are: " + names_of(config.bodies));
  };
  const auto angles = [&](const std::string& where, const StrengthConfig& s) {
    if (s.residual_angle > s.friction_angle)
      add(where + ".residual_angle: must not be above friction_angle");
  };
  if (config.joints.criterion == "rock" && config.joints.unloading == "reversible")
    add("joints.unloading = \"reversible\" needs joints.criterion = \"edge\": a joint that failed "
        "with the rock unloads along the secant");
  for (const MaterialConfig& m : config.materials) angles("material." + m.name + ".joint", m.joint);
  for (const JointConfig& j : config.joint_laws) angles("joint." + j.name, j.strength);
  for (const BodyConfig& b : config.bodies) look_for_loose_grains(config, b, add);
  for (const SupportConfig& s : config.supports) {
    look_up_body("support." + s.name, s.region.on);
    history("support." + s.name, s.history);
    one_table("support." + s.name + ".velocity", s.velocity, s.history);
    for (const std::string& direction : s.fix)
      if (direction != "x" && direction != "y")
        add("support." + s.name + ".fix: \"" + direction + "\" is no direction; allowed: x, y");
  }
  for (const LoadConfig& l : config.loads) {
    look_up_body("load." + l.name, l.region.on);
    history("load." + l.name, l.history);
    if (l.speed > 0.0 && l.kind != "fluid")
      add("load." + l.name + ".speed: only a fluid has one; kind is \"" + l.kind + "\"");
    one_table("load." + l.name + ".pressure", l.pressure, l.history);
    one_table("load." + l.name + ".traction", l.traction, l.history);
    one_table("load." + l.name + ".force", l.force, l.history);
  }
  for (const ProbeConfig& p : config.probes) {
    for (const std::string& problem : probe_problems(p, in_plane)) add(problem);
    if (!p.on.empty() && places.count(p.on) == 0)
      add("probe." + p.name + ".on = \"" + p.on + "\" is neither a body (" +
          names_of(config.bodies) + ") nor a support (" + names_of(config.supports) + ")");
  }
  for (const std::string& problem : stage_problems(config)) add(problem);
  return problems;
}

}  // namespace breccia::fdem
