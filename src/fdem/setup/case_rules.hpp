#pragma once
// Rules of a case that triangles and tetrahedra share: names that lead nowhere, tables that do not
// fit.

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "core/most_names.hpp"
#include "core/named.hpp"
#include "core/unused_motion.hpp"
#include "exec/error.hpp"
#include "fdem/setup/materials.hpp"

namespace breccia::fdem {

/// "a, b", or "none".
template <class Items>
std::string listed_names(const Items& items) {
  std::string names;
  for (const auto& item : items) names += (names.empty() ? "" : ", ") + item.name;
  return names.empty() ? "none" : names;
}

template <class Config>
class CaseRules {
 public:
  /// @param laws        a plane case with the materials, joints and frictions of the case
  /// @param directions  that a support may prescribe
  CaseRules(const Config& config, const fdem::Config& laws,
            const std::vector<std::string>& directions)
      : config_(config), directions_(directions) {
    if (config.precision == "single" && !std::is_same_v<Config, fdem::Config>)
      add("precision: \"single\" is for links of spheres and for triangles; allowed here are "
          "double, mixed");
    if (config.materials.empty()) add("material: at least one [material.<name>] is needed");
    add_too_many(config.supports.size(), "supports", problems);
    add_too_many(config.loads.size(), "loads", problems);
    add_too_many(laws.joint_laws.size(), "joint laws", problems);
    add_too_many(config.materials.size(), "materials", problems, most_materials);
    if (config.materials.size() <= most_materials) {
      attempt([&] { bond_table(laws); });
      attempt([&] { contact_table(laws); });
    }
    check_strengths();
    for (const auto& body : config.bodies) look_for_loose_grains(body);
    check_supports();
    check_loads();
    check_probes();
  }
  std::vector<std::string> problems;

 private:
  void add(const std::string& text) { problems.push_back(text); }
  void attempt(const std::function<void()>& part) {
    try {
      part();
    } catch (const InputError& error) {
      add(error.what());
    }
  }

  void check_strengths() {
    const auto angles = [&](const std::string& where, const StrengthConfig& s) {
      if (s.residual_angle > s.friction_angle)
        add(where + ".residual_angle: must not be above friction_angle");
    };
    if (config_.joints.criterion == "rock" && config_.joints.unloading == "reversible")
      add("joints.unloading = \"reversible\" needs joints.criterion = \"edge\": a joint that "
          "failed "
          "with the rock unloads along the secant");
    for (const MaterialConfig& m : config_.materials)
      angles("material." + m.name + ".joint", m.joint);
    for (const JointConfig& j : config_.joint_laws) angles("joint." + j.name, j.strength);
  }

  /// Minerals of which one breaks and one does not need a joint between them: grains would lie
  /// loose.
  template <class Body>
  void look_for_loose_grains(const Body& body) {
    if (body.grains.kind.empty()) return;
    const auto breaks = [&](const std::string& name) {
      const auto m = std::find_if(config_.materials.begin(), config_.materials.end(),
                                  [&](const MaterialConfig& each) { return each.name == name; });
      return m == config_.materials.end() || m->joints != "none";
    };
    const auto joined = [&](const std::string& a, const std::string& b) {
      return std::any_of(config_.joint_laws.begin(), config_.joint_laws.end(),
                         [&](const JointConfig& j) {
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

  void check_history(const std::string& where, const HistoryConfig& h) {
    if (h.times.size() != h.factors.size()) add(where + ": times and factors must be equally many");
    if (!std::is_sorted(h.times.begin(), h.times.end(), std::less_equal<>()))
      add(where + ".times: must grow from one to the next");
  }
  template <class Quantity>
  void check_one_table(const std::string& where, const Quantity& quantity, const HistoryConfig& h) {
    if (quantity.is_table() && !h.times.empty())
      add(where + " is a table over time; times and factors would be a second one");
  }
  void check_body(const std::string& where, const std::string& on) {
    const std::vector<std::string> bodies = breccia::names_of(config_.bodies);
    if (!on.empty() && std::find(bodies.begin(), bodies.end(), on) == bodies.end())
      add(where + ".on = \"" + on + "\" is not a body; there are: " + listed_names(config_.bodies) +
          meant_name(on, bodies));
  }

  template <class Region>
  void check_region(const std::string& where, const Region& r) {
    check_body(where, r.on);
    bool upward = r.min.x <= r.max.x && r.min.y <= r.max.y;
    if constexpr (requires { r.min.z; }) upward = upward && r.min.z <= r.max.z;
    if (!upward) add(where + ": min must not be above max");
  }

  void check_supports() {
    for (const auto& b : config_.bodies) places_.insert(b.name);
    for (const auto& s : config_.supports)
      if (!places_.insert(s.name).second)
        add("support." + s.name + ": the name is taken by a body or support");
    for (const auto& s : config_.supports) {
      check_region("support." + s.name, s.region);
      check_history("support." + s.name, s.history);
      check_one_table("support." + s.name + ".velocity", s.velocity, s.history);
      for (const std::string& direction : s.fix)
        if (std::find(directions_.begin(), directions_.end(), direction) == directions_.end())
          add("support." + s.name + ".fix: \"" + direction +
              "\" is no direction; allowed: " + words_of(directions_));
    }
  }

  void check_loads() {
    for (const auto& l : config_.loads) {
      check_region("load." + l.name, l.region);
      check_history("load." + l.name, l.history);
      check_one_table("load." + l.name + ".pressure", l.pressure, l.history);
      check_one_table("load." + l.name + ".traction", l.traction, l.history);
      check_one_table("load." + l.name + ".force", l.force, l.history);
      if (!l.dug_by.empty()) check_dug("load." + l.name + ".dug_by", l);
      check_kind("load." + l.name, l.kind, l);
    }
    for (const auto& stage : config_.stages)
      for (const auto& change : stage.loads)
        for (const auto& l : config_.loads)
          if (l.name == change.name)
            check_kind("stage." + stage.name + ".load." + l.name, l.kind, change);
  }

  /// Sizes that its kind does not use. Fluids have a pressure, and rules of their own.
  template <class Load>
  void check_kind(const std::string& where, const std::string& kind, const Load& load) {
    const auto look = [&](const std::string& key, bool given) {
      if (given && kind != key)
        add(where + "." + key + " has no use: the load is of kind \"" + kind + "\"; kind = \"" +
            key + "\" takes it");
    };
    if (kind != "fluid") look("pressure", is_given(load.pressure));
    look("traction", is_given(load.traction));
    look("force", is_given(load.force));
  }

  template <class Load>
  void check_dug(const std::string& where, const Load& load) {
    const auto stage = std::find_if(config_.stages.begin(), config_.stages.end(),
                                    [&](const auto& each) { return each.name == load.dug_by; });
    if (stage == config_.stages.end())
      add(where + " = \"" + load.dug_by +
          "\" is no stage; there are: " + listed_names(config_.stages) +
          meant_name(load.dug_by, breccia::names_of(config_.stages)));
    else if (stage->remove.empty())
      add(where + " = \"" + load.dug_by +
          "\": that stage takes no body out, and lays nothing bare");
    if (load.kind == "fluid" || load.kind == "absorbing")
      add(where + ": pressure, traction and force act on what a stage lays bare; kind \"" +
          load.kind + "\" on the border at the start alone");
  }

  void check_probes() {
    std::string bolts;
    if constexpr (requires { config_.bolts; }) {
      for (const auto& b : config_.bolts) places_.insert(b.name);
      if (!config_.bolts.empty()) bolts = " nor a bolt (" + listed_names(config_.bolts) + ")";
    }
    for (const auto& p : config_.probes)
      if (!p.on.empty() && places_.count(p.on) == 0)
        add("probe." + p.name + ".on = \"" + p.on + "\" is neither a body (" +
            listed_names(config_.bodies) + ") nor a support (" + listed_names(config_.supports) +
            ")" + bolts + meant_name(p.on, {places_.begin(), places_.end()}));
  }

  static std::string words_of(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
  }

  const Config& config_;
  const std::vector<std::string>& directions_;
  std::set<std::string> places_;  ///< bodies, supports and bolts
};

}  // namespace breccia::fdem
