#include "run/results/summary.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exec/memory.hpp"
#include "exec/no_memory.hpp"
#include "io/json.hpp"

namespace breccia {
namespace {

/// A count as an integer, any other number as it is.
Json number(double value) {
  if (value == std::floor(value) && std::abs(value) < 9e15) return static_cast<std::int64_t>(value);
  return value;
}

std::vector<std::string> parts(const std::string& path) {
  std::vector<std::string> result{""};
  for (const char c : path) {
    if (c == '.')
      result.emplace_back();
    else
      result.back() += c;
  }
  return result;
}

void put(Json& json, const Fact& fact) {
  Json* place = &json;
  for (const std::string& part : parts(fact.path)) place = &(*place)[part];
  *place = number(fact.value);
}

Json energy_json(const EnergyBalance& energy, double kinetic_share) {
  return {{"kinetic", energy.kinetic},
          {"elastic", energy.elastic},
          {"fracture", energy.fracture},
          {"plastic", energy.plastic},
          {"friction", energy.friction},
          {"damping", energy.damping},
          {"contact", energy.contact},
          {"work", energy.work},
          {"error_relative", energy.error_relative},
          {"contact_relative", energy.contact_relative},
          {"kinetic_share", kinetic_share}};
}

Json check_json(const CheckResult& check) {
  return {{"name", check.name},         {"value", check.value ? Json(*check.value) : Json(nullptr)},
          {"expected", check.expected}, {"tolerance", check.tolerance},
          {"unit", check.unit},         {"pass", check.pass}};
}

Json json_of(const Summary& s) {
  const Build& build = this_build();
  Json json;
  json["status"] = s.status;
  json["exit_code"] = s.exit_code;
  json["message"] = s.message;
  if (!s.warnings.empty()) json["warnings"] = s.warnings;
  json["breccia"] = {{"version", build.version},
                     {"commit", build.commit},
                     {"build",
                      {{"type", build.type},
                       {"compiler", build.compiler},
                       {"cuda", build.cuda},
                       {"mpi", build.mpi}}}};
  json["case"] = {{"name", s.case_name}, {"sha256", s.case_sha256}, {"seed", s.seed}};
  json["method"] = s.method;
  json["precision"] = s.precision;
  json["machine"] = {{"cpu", s.machine.cpu},
                     {"device", s.machine.device},
                     {"threads", s.machine.threads},
                     {"ranks", s.machine.ranks}};
  for (const Fact& fact : s.facts)
    if (fact.path.starts_with("model.")) put(json, fact);
  json["steps"] = s.steps;
  json["time"] = s.time;
  json["dt"] = {{"min", s.dt_min}, {"max", s.dt_max}, {"last", s.dt_last}};
  if (!s.dt_rule.empty()) json["dt"]["ruled_by"] = s.dt_rule;
  json["wall_s"] = {{"total", s.total}, {"setup", s.setup}, {"loop", s.loop}, {"output", s.output}};
  json["step_us"] = {{"median", s.step_median}, {"p95", s.step_p95}};
  json["stages_s"] = s.stages;
  for (const Fact& fact : s.facts)
    if (fact.path.find('.') == std::string::npos) put(json, fact);
  json["peak_memory_bytes"] = s.peak_memory;
  if (s.machine.device.starts_with("cuda"))
    json["peak_device_bytes"] = peak_array_bytes(Space::cuda);
  if (s.energy) json["energy"] = energy_json(*s.energy, s.kinetic_share);
  for (const Fact& fact : s.facts)
    if (fact.path.find('.') != std::string::npos && !fact.path.starts_with("model."))
      put(json, fact);
  if (s.state_hash) json["state_hash"] = fmt::format("{:016x}", *s.state_hash);
  for (const ProbeRange& probe : s.probes)
    json["probe"][probe.name] = {{"last", probe.last}, {"min", probe.min}, {"max", probe.max}};
  for (const StageRecord& stage : s.stages_of_case) {
    Json one{{"name", stage.name}, {"begin", stage.begin}};
    if (!stage.ended_by.empty()) one.update({{"end", stage.end}, {"ended_by", stage.ended_by}});
    json["stage"].push_back(std::move(one));
  }
  if (!s.checks.empty()) {
    json["checks"] = Json::array();
    for (const CheckResult& check : s.checks) json["checks"].push_back(check_json(check));
  }
  return json;
}

}  // namespace

std::string to_json(const Summary& summary) {
  const NeedsMemory scope;
  return json_text(json_of(summary), 2) + "\n";
}

std::optional<double> number_at(const Summary& summary, const std::string& path) {
  // A probe's name may hold dots, so its value is the part after the last one.
  if (path.starts_with("probe.")) {
    const std::size_t dot = path.rfind('.');
    for (const ProbeRange& probe : summary.probes) {
      if (dot < 6 || path.substr(6, dot - 6) != probe.name) continue;
      const std::string which = path.substr(dot + 1);
      if (which == "last") return probe.last;
      if (which == "min") return probe.min;
      if (which == "max") return probe.max;
    }
    return std::nullopt;
  }
  const NeedsMemory scope;
  const Json json = json_of(summary);
  const Json* place = &json;
  for (const std::string& part : parts(path)) {
    if (!place->is_object() || !place->contains(part)) return std::nullopt;
    place = &(*place)[part];
  }
  if (!place->is_number()) return std::nullopt;
  return place->get<double>();
}

}  // namespace breccia
