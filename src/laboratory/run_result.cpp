#include "laboratory/run_result.hpp"

#include <cmath>

#include "exec/error.hpp"
#include "exec/no_memory.hpp"
#include "io/json.hpp"
#include "io/whole_file.hpp"

namespace breccia::laboratory {
namespace {

void flatten(const Json& json, const std::string& path, std::map<std::string, double>& numbers) {
  if (json.is_object())
    for (const auto& [key, value] : json.items())
      flatten(value, path.empty() ? key : path + "." + key, numbers);
  else if (json.is_number())
    numbers[path] = json.get<double>();
}

std::string text_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

CheckedNumber check_of(const Json& json) {
  CheckedNumber check;
  check.name = text_at(json, "name");
  check.unit = text_at(json, "unit");
  if (json.contains("value") && json["value"].is_number())
    check.value = json["value"].get<double>();
  check.expected = json.value("expected", 0.0);
  check.tolerance = json.value("tolerance", 0.0);
  check.pass = json.value("pass", false);
  return check;
}

}  // namespace

std::optional<double> RunResult::number(const std::string& path) const {
  if (const auto found = numbers.find(path); found != numbers.end()) return found->second;
  if (path.starts_with("probe.") && path.ends_with(".peak")) {
    const std::string probe = path.substr(0, path.size() - 4);
    const auto low = numbers.find(probe + "min"), high = numbers.find(probe + "max");
    if (low == numbers.end() || high == numbers.end()) return std::nullopt;
    return std::abs(low->second) > std::abs(high->second) ? low->second : high->second;
  }
  for (const CheckedNumber& check : checks)
    if (check.name == path) return check.value;
  return std::nullopt;
}

std::optional<RunResult> read_result(const std::string& folder) {
  const NeedsMemory scope;
  Json json;
  try {
    json = read_json(read_whole_file(folder + "/summary.json"));
  } catch (const IoError&) {
    return std::nullopt;
  }
  if (!json.is_object()) return std::nullopt;
  RunResult result;
  result.status = text_at(json, "status");
  result.message = text_at(json, "message");
  result.exit_code = json.value("exit_code", 0);
  if (json.contains("case") && json["case"].is_object())
    result.digest = text_at(json["case"], "sha256");
  flatten(json, "", result.numbers);
  if (json.contains("checks") && json["checks"].is_array())
    for (const Json& check : json["checks"])
      if (check.is_object()) result.checks.push_back(check_of(check));
  if (json.contains("probe") && json["probe"].is_object())
    for (const auto& [name, range] : json["probe"].items()) result.probes.push_back(name);
  return result;
}

}  // namespace breccia::laboratory
