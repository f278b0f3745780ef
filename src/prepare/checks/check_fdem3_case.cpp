#include <fmt/format.h>

#include <algorithm>

#include "core/named.hpp"
#include "core/probe.hpp"
#include "exec/error.hpp"
#include "fdem/setup/bedding.hpp"
#include "fdem/setup/case_rules.hpp"
#include "fdem3/setup/bolts.hpp"
#include "fdem3/setup/materials.hpp"
#include "fdem3/setup/stages.hpp"
#include "fdem_shared/setup/bolts.hpp"
#include "fdem_shared/setup/explosives.hpp"
#include "fdem_shared/setup/fluid_rules.hpp"
#include "prepare/checks/check_bodies.hpp"

namespace breccia::prepare {
namespace {

class TetCaseChecks {
 public:
  explicit TetCaseChecks(const fdem3::Config& config) : config_(config) {
    for (const fdem3::MaterialConfig& m : config.materials) {
      if (m.poisson >= 0.5)
        add("material." + m.name + ".poisson: must be below 0.5 in three dimensions");
      if (m.bedding.angle != 0.0)
        add("material." + m.name + ".bedding.angle is of triangles; normal tells planes in space");
      const bool has_planes = m.bedding.strength != 1.0 || m.bedding.has_stiffness();
      if (has_planes && !(norm(m.bedding.normal) > 0.0))
        add("material." + m.name + ".bedding.normal: its planes need a direction across them");
      if (m.bedding.has_stiffness()) check_stiffness(m);
    }
    for (const fdem3::SupportConfig& s : config.supports)
      check_region("support." + s.name, s.region);
    for (const fdem3::LoadConfig& l : config.loads) check_region("load." + l.name, l.region);
    fdem_shared::check_fluids(config, problems_);
    fdem_shared::check_gas(config, problems_);
    fdem_shared::add_probe_problems(config, in_solid, 3, problems_);
    for (const std::string& problem : fdem3::bolt_problems(config)) add(problem);
    for (const std::string& problem : fdem3::stage_problems(config)) add(problem);
  }
  std::vector<std::string> problems_;

 private:
  void add(const std::string& text) { problems_.push_back(text); }

  void check_stiffness(const fdem3::MaterialConfig& m) {
    try {
      fdem::refuse_impossible_bedding(m);
    } catch (const InputError& error) {
      add(error.what());
    }
    if (m.joints != "none" && config_.joints.criterion == "rock")
      add("material." + m.name +
          ".bedding: where rock is stiffer in one direction than in others, joints in space fail "
          "by "
          "their own tractions: joints.criterion = \"edge\", or joints = \"none\"");
  }

  void check_region(const std::string& where, const fdem3::RegionConfig& r) {
    if (!r.around.empty() && !(r.radius > 0.0) && r.polygon.empty())
      add(where + ".around: a cylinder needs a radius above 0");
  }

  const fdem3::Config& config_;
};

}  // namespace

std::vector<std::string> case_problems(const fdem3::Config& config) {
  const std::vector<std::string> directions{"x", "y", "z"};
  std::vector<std::string> problems =
      fdem::CaseRules<fdem3::Config>(config, fdem3::shared_keys(config), directions).problems;
  for (const auto& more :
       {TetCaseChecks(config).problems_, body_problems(config), overlap_problems(config.bodies)})
    problems.insert(problems.end(), more.begin(), more.end());
  return problems;
}

}  // namespace breccia::prepare
