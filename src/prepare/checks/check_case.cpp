#include "prepare/checks/check_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/most_names.hpp"
#include "core/most_steps.hpp"
#include "core/named.hpp"
#include "core/probe.hpp"
#include "dem/setup/materials.hpp"
#include "dem/setup/stages.hpp"
#include "dem/setup/walls.hpp"
#include "fdem/setup/check_case.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/checks/check_bodies.hpp"
#include "prepare/checks/check_in_situ.hpp"
#include "prepare/checks/refusal.hpp"
#include "prepare/checks/shape_keys.hpp"
#include "prepare/ldpm/body.hpp"
#include "prepare/meshing/joint_sets.hpp"

namespace breccia {
namespace {

/// Spheres have no few that rule the step.
template <class Config>
void check_added_mass(const Config& config, std::vector<std::string>& problems) {
  if constexpr (requires { config.walls; })
    if (config.time.added_mass > 0.0)
      problems.push_back(
          "time.added_mass is for triangles and tetrahedra, whose steps a few slivers may rule; "
          "time.mass_scaling makes all spheres heavier");
}

/// Steps that are so short that the end is never reached.
void check_time(const TimeConfig& time, std::vector<std::string>& problems) {
  if (time.max_step * most_steps > time.end) return;
  problems.push_back(fmt::format(
      "time.max_step = {:.3g} s: time.end = {:.3g} s is more than 1e15 steps away; {:.2g} s is the "
      "least that is allowed here, and steps are as short as the case needs without it",
      time.max_step, time.end, 1.1 * time.end / most_steps));
}

/// A body that flies would have time.mass_scaling times its kinetic energy.
template <class Config>
void check_mass_scaling(const Config& config, std::vector<std::string>& problems) {
  if (config.time.mass_scaling == 1.0) return;
  const auto add = [&](const std::string& what) {
    problems.push_back(fmt::format(
        "time.mass_scaling = {} is for quasi-static runs, and {} begins with a velocity: "
        "it would have {} times its kinetic energy; leave one of the keys out",
        config.time.mass_scaling, what, config.time.mass_scaling));
  };
  for (const auto& body : config.bodies)
    if (dot(body.velocity, body.velocity) > 0.0) add("body." + body.name);
  if constexpr (requires { config.walls; })
    for (const auto& wall : config.walls)
      if (wall.has_mass() && norm(wall.velocity.value) + norm(wall.spin.value) > 0.0)
        add("wall." + wall.name);
}

}  // namespace

namespace dem {
namespace {

class Check {
 public:
  explicit Check(const Config& config) : config_(config) {
    for (const MaterialConfig& m : config_.materials) check(m);
    for (const std::string& problem : prepare::body_problems(config)) add(problem);
    for (const BodyConfig& b : config.bodies)
      for (const std::string& problem : prepare::keys_of_other_shapes(b)) add(problem);
    for (const std::string& problem : prepare::overlap_problems(config.bodies)) add(problem);
    for (const WallConfig& w : config_.walls) {
      for (const std::string& problem : wall_problems(w)) add(problem);
      if (w.is_turning() && config_.contact.rolling_stiffness > 0.0)
        add("wall." + w.name +
            ".free: contacts bear no moments on a wall that turns; contact.rolling_stiffness must "
            "be 0");
    }
    add_too_many(config_.walls.size() + config_.supports.size(), "walls and supports", problems_);
    for (const SupportConfig& s : config_.supports) check(s);
    for (const ProbeConfig& p : config_.probes) check(p);
    check_time(config_.time, problems_);
    check_mass_scaling(config_, problems_);
    check_added_mass(config_, problems_);
    for (const std::string& problem : stage_problems(config)) add(problem);
    for (const StageConfig& stage : config_.stages)
      for (const SupportChange& change : stage.supports)
        if (change.fix != std::vector<std::string>{"same"})
          check_fix("stage." + stage.name + ".support." + change.name, change.fix);
  }
  std::vector<std::string> problems_;

 private:
  void add(const std::string& problem) { problems_.push_back(problem); }

  void check(const MaterialConfig& m) {
    const std::string path = "material." + m.name;
    if (dem::kind_within(m.law) && m.poisson > 1.0 / m.alpha)
      add(
          fmt::format("{}.poisson = {} is above 1 / alpha = {:.4g}: links would have a negative "
                      "shear stiffness",
                      path, m.poisson, 1.0 / m.alpha));
    if (m.knee_strength > 0.0 && !(m.knee_strength + m.knee_opening < 1.0))
      add(
          fmt::format("{}: knee_strength + knee_opening must be below 1 (they are {} and {}): "
                      "softening is steep before its knee",
                      path, m.knee_strength, m.knee_opening));
    if (m.friction_bound == "smooth" && m.friction_cap == 0.0)
      add(fmt::format("{}: friction_bound = \"smooth\" needs friction_cap above 0", path));
    const double across = m.tensile_strength * std::tan(m.friction_angle);
    if (m.criterion == "hyperbola" && !(m.cohesion > across))
      add(
          fmt::format("{}: criterion = \"hyperbola\" needs a cohesion above tensile_strength times "
                      "tan(friction_angle) = {:.4g} Pa (it is {:.4g} Pa): its asymptote must pass "
                      "above the tensile strength",
                      path, across, m.cohesion));
    if (m.law == "ldpm") check_ldpm(m, path);
    if (!m.bedding.is_none()) check_bedding(m, path + ".bedding");
    if (m.law == "interface" && m.bond == "mc90" && !(m.slip1 <= m.slip2 && m.slip2 < m.slip3))
      add(fmt::format("{}: slip1 <= slip2 < slip3 must hold (they are {}, {}, {} m)", path, m.slip1,
                      m.slip2, m.slip3));
  }

  void check_bedding(const MaterialConfig& m, const std::string& path) {
    const BeddingConfig& bedding = m.bedding;
    if (m.law != "concrete" && m.law != "parallel")
      add(
          fmt::format("{}: links of law {} are alike in all directions; laws concrete and parallel "
                      "have a bedding",
                      path, m.law));
    if (!(norm(bedding.normal) > 0.0)) add(path + ".normal has length 0; it must point somewhere");
    if (m.fracture_energy > 0.0 && bedding.strength > bedding.stiffness)
      add(
          fmt::format("{0}.strength = {1} is above stiffness = {2}: links across the planes would "
                      "store energy beyond the opening at which fracture_energy breaks them",
                      path, bedding.strength, bedding.stiffness));
    const bool crushes = m.compaction_strength > 0.0 || m.crushing_strength > 0.0;
    if (crushes && bedding.strength != bedding.stiffness)
      add(path +
          ": with compaction_strength or crushing_strength, strength and stiffness must be "
          "the same");
  }

  /// A sieve curve of grains, if there is one.
  void check_curve(const prepare::MixDesign& mix, const std::string& path) {
    const prepare::Grading& curve = mix.curve;
    if (curve.empty() && curve.passing.empty()) return;
    if (const std::string problem = curve.problem(); !problem.empty()) return add(path + problem);
    if (curve.sieves.front() > mix.smallest || curve.sieves.back() < mix.largest)
      return add(fmt::format("{}.sieves reach from {} to {} m, and grains from {} to {} m", path,
                             curve.sieves.front(), curve.sieves.back(), mix.smallest, mix.largest));
    if (!(curve.passes(mix.largest) > curve.passes(mix.smallest)))
      add(fmt::format("{}.passing leaves no grains from {} to {} m", path, mix.smallest,
                      mix.largest));
  }

  void check_ldpm(const MaterialConfig& m, const std::string& path) {
    const MixConfig& mix = m.mix;
    if (!(m.poisson >= 0.0 && m.poisson < 0.25))
      add(fmt::format("{}.poisson = {}: law ldpm needs 0 to 0.25", path, m.poisson));
    if (!(m.tensile_strength > 0.0 && m.cohesion > 0.0))
      add(path + ": law ldpm needs tensile_strength and cohesion above 0");
    if (m.fracture_energy != 0.0)
      add(path + ".fracture_energy has no use with law ldpm; give ldpm.tensile_length");
    if (!(mix.smallest < mix.largest))
      add(fmt::format("{}.mix.smallest = {} m must be below largest = {} m", path, mix.smallest,
                      mix.largest));
    const prepare::MixDesign design = prepare::mix_of(m);
    check_curve(design, path + ".mix");
    if (!(design.aggregate() > 0.0))
      add(
          fmt::format("{}.mix leaves no room for aggregate: cement, water and air take {:.3g} of "
                      "the volume",
                      path, 1.0 - design.aggregate()));
    if (m.ldpm.final_hardening > m.ldpm.hardening)
      add(path + ".ldpm.final_hardening must not be above hardening");
    if (m.ldpm.final_friction > m.ldpm.friction)
      add(path + ".ldpm.final_friction must not be above friction");
  }

  void check(const SupportConfig& s) {
    if (prepare::item_named(config_.bodies, s.name) != nullptr)
      add(fmt::format("support.{0} and body.{0} have one name; a probe could not tell them apart",
                      s.name));
    if (!s.on.empty() && prepare::item_named(config_.bodies, s.on) == nullptr)
      add(fmt::format("support.{}.on = {:?} is not a body; there are: {}", s.name, s.on,
                      prepare::all_names(config_.bodies, s.on)));
    check_fix("support." + s.name, s.fix);
    if (s.absorbs() && !(s.area > 0.0))
      add("support." + s.name + ".area: an absorbing face needs it");
    if (!s.absorbs() && s.area > 0.0)
      add("support." + s.name + ".area is of an absorbing face; absorb names its normal");
    if (!(s.min.x <= s.max.x && s.min.y <= s.max.y && s.min.z <= s.max.z))
      add("support." + s.name + ": min must not be above max");
  }

  void check_fix(const std::string& where, const std::vector<std::string>& fix) {
    static const std::set<std::string> words{"x", "y", "z", "spin_x", "spin_y", "spin_z", "all"};
    for (const std::string& word : fix)
      if (!words.contains(word))
        add(
            fmt::format("{}.fix: {:?} is no degree of freedom; allowed are x, y, z, spin_x, "
                        "spin_y, spin_z, all",
                        where, word));
  }

  void check(const ProbeConfig& p) {
    if (p.on.empty() || prepare::item_named(config_.bodies, p.on) != nullptr ||
        prepare::item_named(config_.supports, p.on) != nullptr) {
      for (const std::string& problem : probe_problems(p, in_space)) add(problem);
      check_bars(p);
      return;
    }
    if (prepare::item_named(config_.walls, p.on) != nullptr) return check_wall_probe(p);
    std::vector<std::string> known = breccia::names_of(config_.bodies);
    for (const std::vector<std::string>& more :
         {breccia::names_of(config_.supports), breccia::names_of(config_.walls)})
      known.insert(known.end(), more.begin(), more.end());
    add(fmt::format(
        "probe.{}.on = {:?} is neither a body ({}) nor a support ({}) nor a wall ({}){}", p.name,
        p.on, prepare::all_names(config_.bodies), prepare::all_names(config_.supports),
        prepare::all_names(config_.walls), meant_name(p.on, known)));
  }

  /// Only bodies of shape rebar, and files whose material is steel, have bars to read.
  void check_bars(const ProbeConfig& p) {
    if (p.quantity != "axial_force") return;
    const auto has_bars = [&](const dem::BodyConfig& body) {
      const dem::MaterialConfig* const of = prepare::item_named(config_.materials, body.material);
      return body.shape == "rebar" || (of != nullptr && of->law == "steel");
    };
    const dem::BodyConfig* const body = prepare::item_named(config_.bodies, p.on);
    if (body == nullptr ? std::any_of(config_.bodies.begin(), config_.bodies.end(), has_bars)
                        : has_bars(*body))
      return;
    add(fmt::format("probe.{}.quantity = \"axial_force\" is of reinforcement bars, and {} has none",
                    p.name, body == nullptr ? "this case" : "body " + p.on));
  }

  void check_wall_probe(const ProbeConfig& p) {
    if (prepare::item_named(config_.bodies, p.on) != nullptr ||
        prepare::item_named(config_.supports, p.on) != nullptr)
      add(fmt::format(
          "wall.{0} has the name of a body or support; a probe could not tell them apart", p.on));
    const std::vector<std::string> problems = probe_problems(p, of_wall);
    for (const std::string& problem : problems) add(problem);
    if (!problems.empty()) return;
    const Quantity::Kind kind = quantity_named(p.quantity).quantity.kind;
    const bool of_turn = kind == Quantity::Kind::angular_momentum;
    if (of_turn && !prepare::item_named(config_.walls, p.on)->is_turning())
      add(fmt::format(
          "probe.{}.quantity = \"{}\" is of walls with mass that turn; wall.{} does not", p.name,
          p.quantity, p.on));
    const bool needs_mass = kind == Quantity::Kind::momentum || kind == Quantity::Kind::kinetic;
    if (needs_mass && !prepare::item_named(config_.walls, p.on)->has_mass())
      add(fmt::format("probe.{}.quantity = \"{}\" is of walls with mass; wall.{} has none", p.name,
                      p.quantity, p.on));
  }

  const Config& config_;
};

}  // namespace

void check_case(const Config& config) {
  prepare::refuse(Check(config).problems_, "in the case");
}

}  // namespace dem

namespace fdem {

void check_case(const Config& config) {
  std::vector<std::string> problems = case_problems(config);
  for (const auto& more :
       {prepare::body_problems(config.bodies, config.discontinuities, names_of(config)),
        prepare::overlap_problems(config.bodies)})
    problems.insert(problems.end(), more.begin(), more.end());
  for (const BodyConfig& b : config.bodies)
    for (const std::string& problem : prepare::keys_of_other_shapes(b)) problems.push_back(problem);
  for (const std::string& problem : prepare::soft_problems(config)) problems.push_back(problem);
  for (const JointSetConfig& set : config.joint_sets)
    for (const std::string& problem : prepare::joint_set_problems(set, names_of(config).joints))
      problems.push_back(problem);
  check_time(config.time, problems);
  check_mass_scaling(config, problems);
  check_added_mass(config, problems);
  prepare::refuse(problems, "in the case");
}

}  // namespace fdem

namespace fdem3 {

void check_case(const Config& config) {
  std::vector<std::string> problems = prepare::case_problems(config);
  for (const std::string& problem : prepare::soft_problems(config)) problems.push_back(problem);
  check_time(config.time, problems);
  check_mass_scaling(config, problems);
  check_added_mass(config, problems);
  prepare::refuse(problems, "in the case");
}

}  // namespace fdem3
}  // namespace breccia
