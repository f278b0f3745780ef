#include "fdem/check_case.hpp"

#include <algorithm>
#include <functional>
#include <set>

#include "exec/error.hpp"
#include "fdem/materials.hpp"

namespace breccia::fdem {
namespace {

template <class Config>
std::string names_of(const std::vector<Config>& configs) {
  std::string names;
  for (const Config& config : configs) names += (names.empty() ? "" : ", ") + config.name;
  return names.empty() ? "none" : names;
}

}  // namespace

void check_case(const Config& config) {
  std::string problems;
  int count = 0;
  const auto add = [&](const std::string& text) {
    problems += "\n  " + text;
    ++count;
  };
  const auto attempt = [&](const std::function<void()>& part) {
    try {
      part();
    } catch (const InputError& error) {
      add(error.what());
    }
  };
  if (config.materials.empty()) add("material: at least one [material.<name>] is needed");
  if (config.bodies.empty()) add("body: the case has no elements; at least one [[body]] is needed");
  attempt([&] { elastic_table(config); });
  attempt([&] { bond_table(config); });
  attempt([&] { contact_table(config); });
  std::set<std::string> places;
  for (const BodyConfig& b : config.bodies)
    if (!places.insert(b.name).second) add("body." + b.name + ": the name is taken twice");
  for (const SupportConfig& s : config.supports)
    if (!places.insert(s.name).second)
      add("support." + s.name + ": the name is taken by a body or support");
  const auto history = [&](const std::string& where, const HistoryConfig& h) {
    if (h.times.size() != h.factors.size()) add(where + ": times and factors must be equally many");
    if (!std::is_sorted(h.times.begin(), h.times.end(), std::less_equal<>()))
      add(where + ".times: must grow from one to the next");
  };
  const auto look_up_body = [&](const std::string& where, const std::string& on) {
    if (!on.empty() && std::none_of(config.bodies.begin(), config.bodies.end(),
                                    [&](const BodyConfig& b) { return b.name == on; }))
      add(where + ".on = \"" + on + "\" is not a body; there are: " + names_of(config.bodies));
  };
  for (const SupportConfig& s : config.supports) {
    look_up_body("support." + s.name, s.region.on);
    history("support." + s.name, s.history);
    for (const std::string& direction : s.fix)
      if (direction != "x" && direction != "y")
        add("support." + s.name + ".fix: \"" + direction + "\" is no direction; allowed: x, y");
  }
  for (const LoadConfig& l : config.loads) {
    look_up_body("load." + l.name, l.region.on);
    history("load." + l.name, l.history);
  }
  for (const ProbeConfig& p : config.probes) {
    if (p.quantity.ends_with("_z"))
      add("probe." + p.name + ".quantity: a plane case has no z; allowed: x and y");
    if (!p.on.empty() && places.count(p.on) == 0)
      add("probe." + p.name + ".on = \"" + p.on + "\" is neither a body (" +
          names_of(config.bodies) + ") nor a support (" + names_of(config.supports) + ")");
  }
  if (count > 0)
    throw InputError(std::to_string(count) + (count == 1 ? " problem" : " problems") +
                     " in the case; nothing was run." + problems);
}

}  // namespace breccia::fdem
