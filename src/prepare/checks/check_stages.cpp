#include "prepare/checks/check_stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "core/quantity.hpp"
#include "core/stages.hpp"
#include "io/case/units.hpp"
#include "io/round_numbers.hpp"
#include "prepare/checks/by_name.hpp"

namespace breccia::prepare {
namespace {

/// Visitor of each_key that finds the tables over time and ramps below it, and the items that it
/// names.
struct FindTables {
  struct Table {
    std::string key, item;
    double first;  ///< time of its first row  [s]
  };
  std::vector<Table> tables;
  std::vector<Table> ramps;     ///< `first`: when it is over  [s]
  std::set<std::string> items;  ///< "support.grip"
  std::string path{}, item{};   ///< of the innermost table, and of the innermost item of a list

  template <class Value, class... Rest>
  void operator()(const char* name, OverTime<Value>& value, Rest&&...) {
    if (value.is_table()) tables.push_back({path + name, item, value.times.front()});
  }
  template <class... Rest>
  void operator()(const char* name, double& value, Rest&&...) {
    if (std::string_view(name) == "ramp" && value > 0.0)
      ramps.push_back({path + name, item, value});
  }
  template <class... Rest>
  void operator()(const char* name, std::vector<double>& value, Rest&&...) {
    if (std::string_view(name) == "times" && !value.empty())
      tables.push_back({path + name, item, value.front()});
  }
  template <class Value, class... Rest>
  void operator()(const char*, Value&, Rest&&...) {}
  void required(const char*) {}
  template <class Config>
  void table(const char* name, Config& config, const char*) {
    visit(path + name, item, config);
  }
  template <class Config>
  void list(const char* name, std::vector<Config>& configs, const char*) {
    for (Config& config : configs) {
      if constexpr (requires { config.name; }) {
        const std::string own = path + name + "." + config.name;
        items.insert(own);
        visit(own, own, config);
      } else {
        visit(path + name, item, config);
      }
    }
  }
  template <class Config>
  void named(const char*, std::vector<Config>&, const char*) {}

 private:
  template <class Config>
  void visit(const std::string& into, const std::string& of, Config& config) {
    const std::string above = path, outer = item;
    path = into + ".";
    item = of;
    config.each_key(*this);
    path = above;
    item = outer;
  }
};

/// Times that a stage takes.
double least_of(const StageEnd& s) {
  const bool by_time_alone = s.rest == 0.0 && s.when.empty() && s.drop == 0.0;
  return by_time_alone ? s.until : 0.0;
}
double most_of(const StageEnd& s) {
  return s.until > 0.0 ? s.until : no_limit;
}

template <class Config>
std::vector<std::string> doubts(Config config) {
  std::vector<std::string> told;
  const double end = config.time.end;
  auto stages = std::move(config.stages);
  config.stages.clear();
  std::vector<FindTables> found;
  double begin = 0.0;  // at the earliest
  for (auto& stage : stages) {
    found.emplace_back().path = "stage." + stage.name + ".";
    stage.each_key(found.back());
  }
  /// How long an item of stage k, or of the case, stays as that has set it, at most.
  const auto lasts = [&](std::size_t k, std::size_t next, const std::string& item) {
    double time = 0.0;
    for (std::size_t m = k; m < stages.size(); ++m) {
      if (m >= next && found[m].items.contains("stage." + stages[m].name + "." + item)) break;
      time += most_of(stages[m]);
    }
    return stages.empty() ? no_limit : time;
  };
  FindTables whole;
  config.each_key(whole);
  const auto tell_late = [&](const FindTables::Table& table, double over) {
    if (table.first > 0.0 && table.first >= over)
      told.push_back(
          fmt::format("{}: the table begins at {}, and counts for {} at most: its first row holds "
                      "all the time",
                      table.key, time_text(table.first), time_text(over)));
  };
  const auto tell_long = [&](const FindTables::Table& ramp, double over) {
    if (ramp.first > over)
      told.push_back(
          fmt::format("{} = {}: it counts for {} at most, so what it leads reaches {:.3g} % of the "
                      "value given",
                      ramp.key, time_text(ramp.first), time_text(over), 100.0 * over / ramp.first));
  };
  for (const FindTables::Table& table : whole.tables)
    tell_late(table, std::min(end, lasts(0, 0, table.item)));
  for (const FindTables::Table& ramp : whole.ramps)
    tell_long(ramp, std::min(end, lasts(0, 0, ramp.item)));
  for (std::size_t k = 0; k < stages.size(); ++k) {
    if (begin >= end) {
      told.push_back(fmt::format(
          "stage.{}: never begins: the stages before it last {} at least, and time.end is {}",
          stages[k].name, time_text(begin), time_text(end)));
      break;
    }
    const std::size_t own = found[k].path.size();
    for (const FindTables::Table& table : found[k].tables) {
      const std::string item = table.item.empty() ? "" : table.item.substr(own);
      tell_late(table, std::min(end - begin, lasts(k, k + 1, item)));
    }
    for (const FindTables::Table& ramp : found[k].ramps)
      tell_long(ramp, std::min(end - begin,
                               lasts(k, k + 1, ramp.item.empty() ? "" : ramp.item.substr(own))));
    begin += least_of(stages[k]);
  }
  return told;
}

template <class Config>
std::vector<std::string> ends_in_si(Config& config) {
  std::vector<std::string> problems;
  for (auto& stage : config.stages) {
    const std::optional<ProbeRule> rule = ProbeRule::parsed(stage.when);
    if (!rule || rule->unit.empty()) continue;
    const ProbeConfig* const probe = item_named(config.probes, rule->probe);
    if (probe == nullptr) {  // its name is told as the problem
      stage.when = fmt::format("{} {} {:.17g}", rule->probe, rule->sign, rule->limit);
      continue;
    }
    std::string unit = quantity_named(probe->quantity).unit, problem;
    if (config.method == "fdem2d") unit = unit == "N m" ? "N m/m" : per_metre(unit);
    const std::string number = stage.when.substr(stage.when.find(rule->sign) + rule->sign.size());
    const std::size_t first = number.find_first_not_of(" \t");
    const double limit = parse_quantity(number.substr(first), unit, problem);
    if (!problem.empty())
      problems.push_back(fmt::format("stage.{}.when = \"{}\": {}; probe {} reads {}, in {}",
                                     stage.name, stage.when, problem, probe->name, probe->quantity,
                                     unit));
    stage.when = fmt::format("{} {} {:.17g}", rule->probe, rule->sign, limit);
  }
  return problems;
}

}  // namespace

std::vector<std::string> put_ends_in_si(dem::Config& config) {
  return ends_in_si(config);
}
std::vector<std::string> put_ends_in_si(fdem::Config& config) {
  return ends_in_si(config);
}
std::vector<std::string> put_ends_in_si(fdem3::Config& config) {
  return ends_in_si(config);
}
std::vector<std::string> put_ends_in_si(coupled::Config& config) {
  return ends_in_si(config);
}

std::vector<std::string> doubtful_times(const dem::Config& config) {
  return doubts(config);
}
std::vector<std::string> doubtful_times(const fdem::Config& config) {
  return doubts(config);
}
std::vector<std::string> doubtful_times(const fdem3::Config& config) {
  return doubts(config);
}
std::vector<std::string> doubtful_times(const coupled::Config& config) {
  return doubts(config);
}

}  // namespace breccia::prepare
