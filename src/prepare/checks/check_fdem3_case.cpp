#include <fmt/format.h>

#include <algorithm>

#include "core/named.hpp"
#include "core/probe.hpp"
#include "fdem/setup/case_rules.hpp"
#include "prepare/checks/check_bodies.hpp"

namespace breccia::prepare {
namespace {

class TetCaseChecks {
 public:
  explicit TetCaseChecks(const fdem3::Config& config) : config_(config) {
    for (const fdem3::MaterialConfig& m : config.materials)
      if (m.poisson >= 0.5)
        add("material." + m.name + ".poisson: must be below 0.5 in three dimensions");
    for (const fdem3::SupportConfig& s : config.supports) {
      check_region("support." + s.name, s.region);
      check_servo("support." + s.name, s.velocity, s.servo, s.fix);
    }
    for (const fdem3::LoadConfig& l : config.loads) {
      check_region("load." + l.name, l.region);
      check_kind("load." + l.name, l.kind, l);
    }
    for (const ProbeConfig& p : config.probes)
      for (const std::string& problem : probe_problems(p, in_solid)) add(problem);
    for (const std::string& problem :
         stage_problems({config.stages.begin(), config.stages.end()}, names_of(config.probes),
                        names_of(config.bodies)))
      add(problem);
    for (const fdem3::StageConfig& stage : config.stages) check(stage);
  }
  std::vector<std::string> problems_;

 private:
  void add(const std::string& text) { problems_.push_back(text); }

  void check_region(const std::string& where, const fdem3::RegionConfig& r) {
    if (!(r.min.x <= r.max.x && r.min.y <= r.max.y && r.min.z <= r.max.z))
      add(where + ": min must not be above max");
    if (!r.around.empty() && !(r.radius > 0.0))
      add(where + ".around: a cylinder needs a radius above 0");
  }

  /// A quantity that its kind does not use.
  template <class Load>
  void check_kind(const std::string& where, const std::string& kind, const Load& load) {
    const auto is_zero = [](const Vec3& v) { return norm(v) == 0.0; };
    const auto look = [&](const char* key, bool given) {
      if (given && kind != key)
        add(fmt::format("{}.{} has no use: the load is of kind \"{}\"", where, key, kind));
    };
    look("pressure", load.pressure.is_table() || load.pressure.value != 0.0);
    look("traction", load.traction.is_table() || !is_zero(load.traction.value));
    look("force", load.force.is_table() || !is_zero(load.force.value));
  }

  void check_servo(const std::string& where, const OverTime<Vec3>& velocity,
                   const SupportServoConfig& servo, const std::vector<std::string>& fix) {
    if (!servo.is_on()) return;
    if (velocity.is_table() || norm(velocity.value) > 0.0)
      add(where + ": it has a velocity and a servo, which decides that");
    if ((servo.pressure.is_table() || servo.pressure.value != 0.0) && !(servo.area > 0.0))
      add(where + ".servo.area: the pressure needs an area to act on");
    if (std::find(fix.begin(), fix.end(), servo.axis) == fix.end())
      add(where + ".servo.axis = \"" + servo.axis + "\": it does not fix that direction");
  }

  void check(const fdem3::StageConfig& stage) {
    const std::string where = "stage." + stage.name;
    for (const fdem3::SupportChange& change : stage.supports) {
      const std::string path = where + ".support." + change.name;
      add_unknown(where + ".support.name", change.name, "support", names_of(config_.supports),
                  problems_);
      for (const std::string& word : change.fix)
        if (word != "x" && word != "y" && word != "z" && word != "same")
          add(path + ".fix: \"" + word + "\" is no direction; allowed: x, y, z");
      check_servo(path, change.velocity, change.servo, fixed_by(change.name, stage));
    }
    for (const fdem3::LoadChange& change : stage.loads) {
      add_unknown(where + ".load.name", change.name, "load", names_of(config_.loads), problems_);
      for (const fdem3::LoadConfig& load : config_.loads)
        if (load.name == change.name && load.kind == "absorbing")
          add(where + ".load." + change.name + " is absorbing, and has no size");
        else if (load.name == change.name)
          check_kind(where + ".load." + change.name, load.kind, change);
    }
  }

  /// Directions that a support prescribes in a stage.
  std::vector<std::string> fixed_by(const std::string& support,
                                    const fdem3::StageConfig& stage) const {
    std::vector<std::string> fix;
    for (const fdem3::SupportConfig& s : config_.supports)
      if (s.name == support) fix = s.fix;
    for (const fdem3::StageConfig& each : config_.stages) {
      for (const fdem3::SupportChange& change : each.supports)
        if (change.name == support && change.fix != std::vector<std::string>{"same"})
          fix = change.fix;
      if (&each == &stage) break;
    }
    return fix;
  }

  const fdem3::Config& config_;
};

/// The part of a case that both methods read alike.
fdem::Config laws_of(const fdem3::Config& config) {
  fdem::Config laws;
  laws.materials = config.materials;
  laws.joint_laws = config.joint_laws;
  laws.frictions = config.frictions;
  laws.joints = config.joints;
  return laws;
}

}  // namespace

std::vector<std::string> case_problems(const fdem3::Config& config) {
  const std::vector<std::string> directions{"x", "y", "z"};
  std::vector<std::string> problems =
      fdem::CaseRules<fdem3::Config>(config, laws_of(config), directions).problems;
  for (const auto& more :
       {TetCaseChecks(config).problems_, body_problems(config), overlap_problems(config.bodies)})
    problems.insert(problems.end(), more.begin(), more.end());
  return problems;
}

}  // namespace breccia::prepare
