#include "fdem/check_case.hpp"

#include <algorithm>
#include <functional>
#include <set>

#include "exec/error.hpp"
#include "fdem/materials.hpp"

namespace breccia::fdem {

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
  if (config.materials.empty()) add("there is no [material.<name>]");
  if (config.bodies.empty()) add("there is no [[body]]");
  attempt([&] { elastic_table(config); });
  attempt([&] { bond_table(config); });
  attempt([&] { contact_table(config); });
  std::set<std::string> places;
  for (const BodyConfig& b : config.bodies)
    if (!places.insert(b.name).second) add("body " + b.name + ": the name is taken twice");
  for (const SupportConfig& s : config.supports)
    if (!places.insert(s.name).second)
      add("support " + s.name + ": the name is taken by a body or support");
  const auto history = [&](const std::string& where, const HistoryConfig& h) {
    if (h.times.size() != h.factors.size()) add(where + ": times and factors must be equally many");
    if (!std::is_sorted(h.times.begin(), h.times.end(), std::less_equal<>()))
      add(where + ".times: must grow from one to the next");
  };
  for (const SupportConfig& s : config.supports) {
    history("support " + s.name, s.history);
    for (const std::string& direction : s.fix)
      if (direction != "x" && direction != "y")
        add("support " + s.name + ".fix: \"" + direction + "\" is no direction; allowed: x, y");
  }
  for (const LoadConfig& l : config.loads) history("load " + l.name, l.history);
  for (const ProbeConfig& p : config.probes) {
    if (p.quantity.ends_with("_z"))
      add("probe " + p.name + ".quantity: a plane case has no z; allowed: x and y");
    if (!p.on.empty() && places.count(p.on) == 0)
      add("probe " + p.name + ".on: there is no body or support \"" + p.on + "\"");
  }
  if (count > 0)
    throw InputError(std::to_string(count) + (count == 1 ? " problem" : " problems") +
                     " in the case; nothing was run" + problems);
}

}  // namespace breccia::fdem
