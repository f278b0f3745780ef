#pragma once
// A case as it is in one of its stages: what stages change of both finite-discrete methods.

#include <algorithm>
#include <string>
#include <vector>

#include "core/by_stages.hpp"
#include "core/named.hpp"
#include "core/stages.hpp"
#include "core/unused_motion.hpp"
#include "fdem_shared/setup/config.hpp"
#include "fdem_shared/setup/over_time.hpp"

namespace breccia::fdem_shared {

/// Lets a stage change a case.
/// @param begin  time at which it began  [s]
template <class Config, class Stage>
void begin_stage(Config& config, const Stage& stage, double begin) {
  config.removed.insert(config.removed.end(), stage.remove.begin(), stage.remove.end());
  if (stage.local_damping >= 0.0) config.local_damping = stage.local_damping;
  if (stage.friction >= 0.0) config.stage_friction = stage.friction;
  if (stage.gravity.is_table() || stage.gravity.value.x < no_limit) {
    config.gravity = stage.gravity;
    config.gravity_begin = begin;
  }
  for (const auto& change : stage.supports)
    if (auto* const s = find_named(config.supports, change.name)) {
      using Vector = std::remove_cvref_t<decltype(s->point)>;
      s->point = change.point.x < no_limit ? change.point : motion_of<Vector>(*s).point_at(begin);
      if (change.fix != std::vector<std::string>{"same"}) s->fix = change.fix;
      s->velocity = change.velocity;
      s->spin = change.spin;
      if (!change.keeps_free()) s->free = change.free;
      s->force = change.force;
      s->torque = change.torque;
      s->history = {change.ramp, {}, {}, begin};
      s->servo = change.servo;
    }
  for (auto& load : config.loads)
    if (load.dug_by == stage.name && !load.dug_by.empty()) {
      load.dug = true;
      load.history.begin = begin;
    }
  for (const auto& change : stage.loads)
    if (auto* const load = find_named(config.loads, change.name)) {
      load->pressure = change.pressure;
      load->traction = change.traction;
      load->force = change.force;
      load->rate = change.rate;
      load->history = {change.ramp, {}, {}, begin};
    }
  for (const MaterialChange& change : stage.materials)
    if (auto* const m = find_named(config.materials, change.name)) {
      if (change.young > 0.0) m->young_now = change.young;
      if (change.in_situ >= 0.0) m->in_situ_share = change.in_situ;
      if (change.friction >= 0.0) m->friction = change.friction;
      change.joint.apply_to(m->joint);
    }
  for (const JointChange& change : stage.joints)
    if (auto* const joint = find_named(config.joint_laws, change.name))
      change.strength.apply_to(joint->strength);
}

/// Whether some stage makes joints stronger or weaker.
template <class Config>
bool changes_strengths(const Config& config) {
  return std::any_of(config.stages.begin(), config.stages.end(),
                     [](const auto& stage) { return stage.changes_strengths(); });
}

/// Problems of the servos of a case as it is in a stage.
/// @param area   what a servo's pressure acts on: a length or an area
template <class Config>
void add_servo_problems(const Config& now, const char* area, std::vector<std::string>& problems) {
  for (const auto& s : now.supports) {
    if (!s.servo.is_on()) continue;
    const std::string where = "support." + s.name;
    if (s.velocity.is_table() || norm(s.velocity.value) > 0.0)
      problems.push_back(where + ": it has a velocity and a servo, which decides that");
    if ((s.servo.pressure.is_table() || s.servo.pressure.value != 0.0) && !(s.servo.area > 0.0))
      problems.push_back(where + ".servo.area: the pressure needs " + area + " to act on");
    if (s.servo.is_plate() && s.servo.gain != ServoConfig{}.gain)
      problems.push_back(where + ".servo.gain: a plate has none; with mass = inf it counts");
    if (std::find(s.fix.begin(), s.fix.end(), s.servo.axis) == s.fix.end())
      problems.push_back(where + ".servo.axis = \"" + s.servo.axis +
                         "\": it does not fix that direction");
  }
}

/// The largest spin along x, y and z that a support has at any time.  [rad/s]
inline Vec3 largest_spin(const OverTime<double>& spin) {
  double most = std::abs(spin.value);
  for (const double w : spin.values) most = std::max(most, std::abs(w));
  return {0.0, 0.0, most};
}
inline Vec3 largest_spin(const OverTime<Vec3>& spin) {
  Vec3 most{};
  const auto add = [&](const Vec3& w) {
    for (int k = 0; k < 3; ++k)
      part_of(most, k) = std::max(part_of(most, k), std::abs(part_of(w, k)));
  };
  add(spin.value);
  for (const Vec3& w : spin.values) add(w);
  return most;
}

/// Problems of the turns of supports of a case as it is in a stage: a turn moves corners across its
/// axis, which the support must fix and no servo must lead.
template <class Config>
void add_turn_problems(const Config& now, std::vector<std::string>& problems) {
  const std::vector<std::string> words{"x", "y", "z"};
  for (const auto& s : now.supports) {
    const Vec3 spin = largest_spin(s.spin);
    for (int k = 0; k < 3; ++k) {
      const std::string& word = words[at(k)];
      Vec3 across = spin;
      part_of(across, k) = 0.0;
      if (!(norm(across) > 0.0) || s.fix.empty()) continue;
      const bool fixed = std::find(s.fix.begin(), s.fix.end(), word) != s.fix.end();
      if (!fixed)
        problems.push_back("support." + s.name + ".spin moves what it holds along " + word +
                           ", which it does not fix");
      if (s.servo.is_on() && s.servo.axis == word)
        problems.push_back("support." + s.name + ".spin: its servo moves the axis aside, along " +
                           word);
    }
  }
}

/// Problems of bodies that forces move, of a case as it is in a stage.
template <class Config>
void add_free_problems(const Config& now, const std::vector<std::string>& directions,
                       std::vector<std::string>& problems) {
  for (const auto& s : now.supports) {
    const auto add = [&](const std::string& what) {
      problems.push_back("support." + s.name + what);
    };
    const auto has = [](const std::vector<std::string>& list, const std::string& word) {
      return std::find(list.begin(), list.end(), word) != list.end();
    };
    for (const std::string& word : s.free)
      if (word != "turn" && !has(directions, word))
        add(".free: \"" + word + "\" is no direction; allowed are x, y" +
            (directions.size() > 2 ? ", z" : "") + ", turn");
    if (!s.is_free()) {
      if (is_given(s.force)) add(".force acts on what is free; free says in which directions");
      if (is_given(s.torque)) add(".torque acts on what is free; free says how");
      continue;
    }
    for (const std::string& word : directions)
      if (!has(s.fix, word)) {
        add(".free: a body that forces move is rigid, so fix must hold all of its directions");
        break;
      }
    if (s.servo.is_on()) add(".servo: it leads what free lets go; a given force is `force`");
    if (!s.is_turning() && is_given(s.torque)) add(".torque: free does not let it turn");
    if (!s.is_turning() && is_given(s.spin)) add(".spin: free does not let it turn");
    if (s.spin.is_table()) add(".spin: with free it is the one with which it begins, no table");
    for (const auto& row : s.velocity.values)
      for (int axis = 0; axis < static_cast<int>(directions.size()); ++axis)
        if ((s.free_directions() >> axis & 1) != 0 && part_of(row, axis) != 0.0)
          return add(".velocity: along " + directions[at(axis)] +
                     ", which is free, no table leads it");
  }
}

/// Problems of one stage by itself.
/// @param directions  of the method: x, y, z
template <class Config, class Stage>
void add_stage_problems(const Config& config, const Stage& stage,
                        const std::vector<std::string>& directions,
                        std::vector<std::string>& problems) {
  const std::string where = "stage." + stage.name;
  for (const auto& change : stage.supports) {
    add_unknown(where + ".support.name", change.name, "support", names_of(config.supports),
                problems);
    for (const std::string& word : change.fix)
      if (word != "same" &&
          std::find(directions.begin(), directions.end(), word) == directions.end())
        problems.push_back(where + ".support." + change.name + ".fix: \"" + word +
                           "\" is no direction; allowed: x, y" +
                           (directions.size() > 2 ? ", z" : ""));
  }
  for (const MaterialChange& change : stage.materials)
    add_unknown(where + ".material.name", change.name, "material", names_of(config.materials),
                problems);
  for (const JointChange& change : stage.joints)
    add_unknown(where + ".joint.name", change.name, "joint", names_of(config.joint_laws), problems);
  for (const auto& m : config.materials)
    for (const MaterialChange& change : stage.materials)
      if (change.name == m.name && change.joint.any() && m.joints == "none")
        problems.push_back(where + ".material." + m.name + ".joint: it has no joints");
  for (const auto& change : stage.loads) {
    add_unknown(where + ".load.name", change.name, "load", names_of(config.loads), problems);
    for (const auto& load : config.loads)
      if (load.name == change.name && load.kind == "absorbing")
        problems.push_back(where + ".load." + change.name + " is absorbing, and has no size");
  }
}

/// Problems of a stage that gives a velocity to what forces move by then.
template <class Config>
void add_begin_problems(const Config& config, const Config& now, std::size_t stage,
                        std::vector<std::string>& problems) {
  if (stage >= config.stages.size()) return;
  for (const auto& change : config.stages[stage].supports) {
    const auto s = std::find_if(now.supports.begin(), now.supports.end(),
                                [&](const auto& support) { return support.name == change.name; });
    if (s == now.supports.end() || !s->is_free()) continue;
    const std::string where = "stage." + config.stages[stage].name + ".support." + change.name;
    bool leads = is_given(change.spin);
    for (int axis = 0; axis < 3; ++axis)
      if ((s->free_directions() >> axis & 1) != 0 && part_of(change.velocity.value, axis) != 0.0)
        leads = true;
    if (leads)
      problems.push_back(where +
                         ": what is free goes on with the motion that it has; velocity and "
                         "spin cannot lead it");
  }
}

/// Velocities along what is not fixed, and ramps and tables of factors that lead nothing.
template <class Config>
void add_motion_problems(const Config& config, const Config& now, std::size_t stage,
                         std::vector<std::string>& problems) {
  each_given_motion(config, now, stage, [&](const auto& s, const std::string& where) {
    if (!s.is_free() && !s.servo.is_on()) add_unfixed(where, s.fix, s.velocity, problems);
    if (is_given(s.velocity) || is_given(s.spin) || is_given(s.force) || is_given(s.torque)) return;
    const char* const none = s.servo.is_on()
                                 ? " leads nothing: a servo's force grows by a table of its own"
                                 : " leads nothing: the support has no velocity and no spin";
    if (s.history.ramp > 0.0) problems.push_back(where + ".ramp" + none);
    if (!s.history.times.empty()) problems.push_back(where + ".times" + none);
  });
}

/// Problems of the stages of a case, as sentences, each once.
/// @param config_at  config_at(config, progress): the case in a stage
template <class Config, class At>
std::vector<std::string> problems_of_stages(const Config& config,
                                            const std::vector<std::string>& directions,
                                            const char* area, const At& config_at) {
  std::vector<std::string> problems =
      breccia::stage_problems({config.stages.begin(), config.stages.end()}, names_of(config.probes),
                              names_of(config.bodies));
  for (const auto& stage : config.stages) add_stage_problems(config, stage, directions, problems);
  add_by_stages(
      config, problems, [&](const StageProgress& progress) { return config_at(config, progress); },
      [&](const Config& now) {
        std::vector<std::string> found;
        add_servo_problems(now, area, found);
        add_turn_problems(now, found);
        add_free_problems(now, directions, found);
        return found;
      },
      [&](const Config& now, std::size_t k) {
        add_begin_problems(config, now, k, problems);
        add_motion_problems(config, now, k, problems);
      });
  return problems;
}

/// In the order of the alphabet, each once.
inline std::vector<std::string> each_once(std::vector<std::string> problems) {
  std::sort(problems.begin(), problems.end());
  problems.erase(std::unique(problems.begin(), problems.end()), problems.end());
  return problems;
}

}  // namespace breccia::fdem_shared
