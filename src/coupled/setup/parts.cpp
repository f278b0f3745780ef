// A case of two methods, and the case of each.

#include <fmt/format.h>

#include <limits>
#include <set>

#include "core/named.hpp"
#include "coupled/setup/config.hpp"

namespace breccia::coupled {
namespace {

/// Words by which a probe reads all of a method.
constexpr const char* all_spheres = "spheres";
constexpr const char* all_tetrahedra = "tetrahedra";

template <class Items>
bool names(const Items& items, const std::string& name) {
  return std::any_of(items.begin(), items.end(), [&](const auto& i) { return i.name == name; });
}
bool is_of_spheres(const Config& config, const std::string& on) {
  const dem::Config& c = config.spheres;
  return on == all_spheres || names(c.bodies, on) || names(c.supports, on) || names(c.walls, on);
}
bool is_of_tetrahedra(const Config& config, const std::string& on) {
  const fdem3::Config& c = config.tetrahedra;
  return on == all_tetrahedra || names(c.bodies, on) || names(c.supports, on) || names(c.bolts, on);
}

class PairChecks {
 public:
  explicit PairChecks(const Config& config) : config_(config) {
    const std::set<std::string> methods(config.methods.begin(), config.methods.end());
    if (config.methods.size() != 2 || methods != std::set<std::string>{"dem3d", "fdem3d"})
      add("method: of two methods only [\"dem3d\", \"fdem3d\"] is there");
    if (config.precision != "double")
      add("precision: allowed is \"double\" where two methods share a run");
    if (config.spheres.bodies.empty())
      add("spheres.body: there is none; name the bodies of spheres");
    if (config.tetrahedra.bodies.empty())
      add("tetrahedra.body: there is none; name the bodies of tetrahedra");
    check_names();
    std::vector<std::string> bodies = names_of(config.spheres.bodies);
    for (const auto& body : config.tetrahedra.bodies) bodies.push_back(body.name);
    for (const std::string& problem : stage_problems({config.stages.begin(), config.stages.end()},
                                                     names_of(config.probes), bodies))
      add(problem);
    for (const ProbeConfig& p : config.probes) check(p);
    for (const BondConfig& b : config.bonds) check(b);
  }
  std::vector<std::string> problems;

 private:
  void add(std::string text) { problems.push_back(std::move(text)); }

  void check_names() {
    std::set<std::string> taken{all_spheres, all_tetrahedra};
    const auto take = [&](const char* part, const char* list, const auto& items) {
      for (const auto& item : items)
        if (!taken.insert(item.name).second)
          add(fmt::format(
              "{}.{}.{}: the name is taken; bodies, supports, walls and bolts of both methods "
              "need names of their own, and \"{}\" and \"{}\" stand for all of either",
              part, list, item.name, all_spheres, all_tetrahedra));
    };
    take("spheres", "body", config_.spheres.bodies);
    take("spheres", "support", config_.spheres.supports);
    take("spheres", "wall", config_.spheres.walls);
    take("tetrahedra", "body", config_.tetrahedra.bodies);
    take("tetrahedra", "support", config_.tetrahedra.supports);
    take("tetrahedra", "bolt", config_.tetrahedra.bolts);
    std::set<std::string> bonds;
    for (const BondConfig& b : config_.bonds)
      if (!bonds.insert(b.name).second) add(fmt::format("bond.{}: the name is taken", b.name));
  }
  void check(const ProbeConfig& p) {
    if (is_of_spheres(config_, p.on) || is_of_tetrahedra(config_, p.on)) return;
    const std::vector<std::string> names = all_names();
    add(fmt::format(
        "probe.{}.on = {:?}: name a body, a support, a wall or a bolt, or \"{}\" or \"{}\" for "
        "all of them; there are: {}{}",
        p.name, p.on, all_spheres, all_tetrahedra,
        names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")),
        meant_name(p.on, names)));
  }
  std::vector<std::string> all_names() const {
    std::vector<std::string> names;
    const auto list = [&](const auto& items) {
      for (const auto& item : items) names.push_back(item.name);
    };
    list(config_.spheres.bodies), list(config_.spheres.supports), list(config_.spheres.walls);
    list(config_.tetrahedra.bodies), list(config_.tetrahedra.supports);
    list(config_.tetrahedra.bolts);
    return names;
  }
  void check(const BondConfig& b) {
    const auto look = [&](const char* key, const std::string& name, const auto& bodies) {
      if (names(bodies, name)) return;
      std::string known;
      for (const auto& body : bodies) known += (known.empty() ? "" : ", ") + body.name;
      add(fmt::format("bond.{}.{} = {:?} is none of its bodies; there are: {}", b.name, key, name,
                      known.empty() ? "none" : known));
    };
    look("spheres", b.spheres, config_.spheres.bodies);
    look("tetrahedra", b.tetrahedra, config_.tetrahedra.bodies);
  }

  const Config& config_;
};

}  // namespace

std::vector<std::string> case_problems(const Config& config) {
  return PairChecks(config).problems;
}

Parts parts_of(const Config& config) {
  Parts parts{config.spheres, config.tetrahedra, {}};
  const auto share = [&config](auto& part, const char* method) {
    CaseConfig& common = part;
    common = config;
    common.method = method;
    common.probes.clear();
    common.checks.clear();
    part.gravity = config.gravity;
  };
  share(parts.spheres, "dem3d");
  share(parts.tetrahedra, "fdem3d");
  const auto begin = [](const auto& bodies, auto& stages, auto part, const StageConfig& whole) {
    part.name = whole.name;
    part.gravity = whole.gravity;
    for (const std::string& body : whole.remove)
      if (names(bodies, body)) part.remove.push_back(body);
    part.until = std::numeric_limits<double>::max();  // the run tells its end
    part.of_part = true;
    stages.push_back(std::move(part));
  };
  for (const StageConfig& stage : config.stages) {
    begin(parts.spheres.bodies, parts.spheres.stages, dem::StageConfig(stage.spheres), stage);
    begin(parts.tetrahedra.bodies, parts.tetrahedra.stages, fdem3::StageConfig(stage.tetrahedra),
          stage);
  }
  parts.spheres.time.evaluate_every = 1;
  for (const ProbeConfig& p : config.probes) {
    const bool of_spheres = is_of_spheres(config, p.on);
    std::vector<ProbeConfig>& of = of_spheres ? parts.spheres.probes : parts.tetrahedra.probes;
    parts.probes.push_back({of_spheres, of.size()});
    of.push_back(p);
    if (p.on == all_spheres || p.on == all_tetrahedra) of.back().on.clear();
  }
  return parts;
}

}  // namespace breccia::coupled
