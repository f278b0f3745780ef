#include "core/stages.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/named.hpp"

namespace breccia {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string list_of(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all.empty() ? "none" : all;
}

}  // namespace

std::optional<ProbeRule> ProbeRule::parsed(const std::string& text) {
  const std::size_t sign = text.find_first_of("<>=!");
  if (sign == std::string::npos || text[sign] == '=' || text[sign] == '!') return std::nullopt;
  const std::size_t width = text.find('=', sign) == sign + 1 ? 2 : 1;
  ProbeRule rule{trimmed(text.substr(0, sign)), text.substr(sign, width), 0.0, ""};
  const std::string number = trimmed(text.substr(sign + width));
  const char* const end = number.data() + number.size();
  const auto [stop, error] = std::from_chars(number.data(), end, rule.limit);
  if (rule.probe.empty() || error != std::errc{}) return std::nullopt;
  rule.unit = trimmed({stop, end});
  if (rule.unit.find_first_of("<>=!&|,") != std::string::npos) return std::nullopt;
  return rule;
}

const char* word_of(StageCause cause) {
  switch (cause) {
    case StageCause::time:
      return "time";
    case StageCause::rest:
      return "rest";
    case StageCause::probe:
      return "probe";
    case StageCause::drop:
      return "drop";
    case StageCause::none:
      break;
  }
  return "";
}

std::vector<std::string> stage_problems(const std::vector<StageEnd>& stages,
                                        const std::vector<std::string>& probes,
                                        const std::vector<std::string>& bodies) {
  std::vector<std::string> problems, gone;
  const auto is_probe = [&](const std::string& name) {
    return std::find(probes.begin(), probes.end(), name) != probes.end();
  };
  if (stages.size() > most_stages)
    problems.push_back("stage: there are " + std::to_string(stages.size()) + ", at most " +
                       std::to_string(most_stages) + " are possible");
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const StageEnd& s = stages[i];
    const std::string where = "stage." + s.name;
    for (std::size_t k = 0; k < i; ++k)
      if (stages[k].name == s.name)
        problems.push_back(where + ": there are two stages of this name");
    if (!s.ends() && i + 1 < stages.size())
      problems.push_back(where +
                         " never ends: it needs until, rest, when or drop, as only the last "
                         "stage may go on to the end of the case");
    if (!s.when.empty()) {
      const std::optional<ProbeRule> rule = ProbeRule::parsed(s.when);
      if (!rule)
        problems.push_back(where + ".when = \"" + s.when +
                           "\" is not of the form \"probe > 2 kN\": the name of one probe, one "
                           "of <, <=, > and >=, and a number, with a unit or in SI");
      else if (!std::isfinite(rule->limit))
        problems.push_back(where + ".when = \"" + s.when + "\": no probe reads more or less");
      else if (!is_probe(rule->probe))
        problems.push_back(where + ".when: \"" + rule->probe + "\" is not a probe; there are: " +
                           list_of(probes) + meant_name(rule->probe, probes));
      else if (!rule->unit.empty())
        problems.push_back(where + ".when = \"" + s.when + "\": " + rule->unit + " is no unit");
    }
    if (i == 0 && !s.remove.empty())
      problems.push_back(where +
                         ".remove: the first stage begins with the case, and cannot take out what "
                         "it brings; leave the body out, or begin with another stage");
    for (const std::string& body : s.remove) {
      add_unknown(where + ".remove", body, "body", bodies, problems);
      if (std::find(gone.begin(), gone.end(), body) != gone.end())
        problems.push_back(where + ".remove: \"" + body + "\" has been taken out before");
      gone.push_back(body);
    }
    const auto is_gone = [&](const std::string& body) {
      return std::find(gone.begin(), gone.end(), body) != gone.end();
    };
    if (!s.remove.empty() && !s.of_part && !bodies.empty() &&
        std::all_of(bodies.begin(), bodies.end(), is_gone))
      problems.push_back(where + ".remove takes out all that is left; a body must stay");
    if (s.drop > 0.0 && !is_probe(s.drop_of))
      problems.push_back(where + ".drop_of = \"" + s.drop_of +
                         "\" is not a probe, which drop needs; there are: " + list_of(probes) +
                         meant_name(s.drop_of, probes));
    if (s.drop == 0.0 && !s.drop_of.empty())
      problems.push_back(where + ".drop_of says which probe drop looks at, and there is no drop");
  }
  return problems;
}

}  // namespace breccia
