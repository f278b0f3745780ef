#include "run/results/messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "io/round_numbers.hpp"
#include "run/results/progress.hpp"

namespace breccia {
namespace {

std::optional<double> fact(const std::vector<Fact>& facts, const std::string& path) {
  for (const Fact& candidate : facts)
    if (candidate.path == path) return candidate.value;
  return std::nullopt;
}
std::optional<double> fact(const Summary& summary, const std::string& path) {
  return fact(summary.facts, path);
}

/// The shares of the stages in the time spent, largest first.
std::string stage_shares(const Summary& s) {
  const double all = s.loop + s.output;
  if (all <= 0.0) return "";
  std::vector<std::pair<double, std::string>> shares{{s.output, "output"}};
  double other = s.loop;
  for (const auto& [name, seconds] : s.stages) {
    if (name == "output") continue;
    shares.emplace_back(seconds, name);
    other -= seconds;
  }
  std::stable_sort(shares.begin(), shares.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  shares.emplace_back(other, "other");
  std::string text;
  for (const auto& [seconds, name] : shares)
    if (seconds >= 0.005 * all) text += fmt::format("{} {:.0f} %  ", name, 100.0 * seconds / all);
  return text;
}

/// Moduli of bodies of the DEM as their links have them, one line each.
std::string elasticity_text(const std::vector<Fact>& facts) {
  const std::string prefix = "model.elasticity.", last = ".young";
  std::string text;
  for (const auto& [path, young] : facts) {
    const std::size_t end = path.rfind(last);
    if (path.rfind(prefix, 0) != 0 || end == std::string::npos) continue;
    const std::string body = path.substr(prefix.size(), end - prefix.size());
    const auto of_body = [&](const char* name) {
      return fact(facts, prefix + body + name).value_or(0.0);
    };
    text += fmt::format("elastic {}   E {:.3g} GPa, nu {:.3f}", body, 1e-9 * young,
                        of_body(".poisson"));
    if (of_body(".factor") != 1.0 || of_body(".packed_young") != young)
      text += fmt::format("   as packed {:.3g} GPa, {:.3f}", 1e-9 * of_body(".packed_young"),
                          of_body(".packed_poisson"));
    text += "\n";
  }
  return text;
}

}  // namespace

std::string opening_text(const Summary& s, const RunEnd& end, const std::string& folder) {
  std::string text =
      fmt::format("breccia {}  {} x{} {}{}\n", this_build().version, s.machine.device,
                  s.machine.threads, s.machine.threads == 1 ? "thread" : "threads",
                  s.machine.ranks > 1 ? fmt::format(" on each of {} ranks", s.machine.ranks) : "");
  text += fmt::format("case    {}   {}", s.case_name, s.method);
  if (s.precision != "double") text += fmt::format("   {} precision", s.precision);
  for (const char* kind : {"elements", "links", "triangles", "tetrahedra", "joints"})
    if (const auto count = fact(s, std::string("model.") + kind); count && *count > 0.0)
      text += fmt::format("   {} {}", count_text(*count), kind);
  text += fmt::format("   memory {:.0f} MB\n", static_cast<double>(s.peak_memory) / 1e6);
  text += elasticity_text(s.facts);
  const double left_by_steps = static_cast<double>(std::max<std::int64_t>(end.steps - s.steps, 0));
  const double left_by_time =
      s.dt_last > 0.0 ? std::max(0.0, std::ceil((end.time - s.time) / s.dt_last)) : left_by_steps;
  text += "step    ";
  if (s.dt_last > 0.0)
    text += fmt::format("dt {:.3g} s{}   ", s.dt_last,
                        s.dt_rule.empty() ? "" : " ruled by " + s.dt_rule);
  if (left_by_steps <= left_by_time && end.steps != std::numeric_limits<std::int64_t>::max())
    text += fmt::format("{} steps\n", count_text(left_by_steps));
  else if (s.dt_last > 0.0)
    text += fmt::format("{}about {} steps to {}\n", end.may_be_earlier ? "at most " : "",
                        count_text(left_by_time), time_text(end.time));
  else
    text += fmt::format("to {}\n", time_text(end.time));
  if (s.steps > 0)
    text += fmt::format("from    step {}, {}\n", count_text(static_cast<double>(s.steps)),
                        time_text(s.time));
  return text + fmt::format("folder  {}\n", folder);
}

std::string broken_text(const std::vector<Fact>& facts) {
  const auto links = fact(facts, "fracture.broken_links");
  if (links && fact(facts, "model.links").value_or(0.0) > 0.0)
    return "broken links " + count_text(*links);
  const auto joints = fact(facts, "fracture.broken_joints");
  if (joints && fact(facts, "model.joints").value_or(0.0) > 0.0)
    return "broken joints " + count_text(*joints);
  return "";
}

std::string inertia_text(double mass_scaling, double kinetic_share) {
  constexpr double quasi_static = 0.02;  // of the work
  if (mass_scaling == 1.0 || kinetic_share <= quasi_static) return "";
  return fmt::format(
      "not quasi-static: with time.mass_scaling = {:g} the kinetic energy has come to {:.2g} % of "
      "the work; forces depend on the scaling. A slower load or a smaller scaling helps; pieces "
      "that fly off after a failure do no harm to the forces before it",
      mass_scaling, 100.0 * kinetic_share);
}

std::string unbegun_text(const std::vector<StageEnd>& stages, int present) {
  const auto next = static_cast<std::size_t>(present + 1);
  if (next >= stages.size()) return "";
  return fmt::format(
      "the case ended by time.end in stage {0}: stage {1} has not begun. A later time.end, or a "
      "rule that ends {0} sooner, helps",
      stages[next - 1].name, stages[next].name);
}

std::string closing_text(const Summary& s, std::int64_t frames, const std::string& folder) {
  std::string text =
      fmt::format("{:<7} {} in {}   {} steps   {} frames", s.status, time_text(s.time),
                  duration_text(s.total), count_text(static_cast<double>(s.steps)), frames);
  if (const std::string broken = broken_text(s.facts); !broken.empty()) text += "   " + broken;
  if (s.energy) text += fmt::format("   energy error {:.2g} %", 100.0 * s.energy->error_relative);
  text += '\n';
  if (const std::string shares = stage_shares(s); !shares.empty()) {
    text += fmt::format("stage   {}", shares);
    if (s.step_median > 0.0) text += fmt::format("{:.4g} us a step", s.step_median);
    if (const auto links = fact(s, "model.links"); links && s.step_median > 0.0 && *links > 0.0)
      text += fmt::format("   {:.1f} M link-steps/s", *links / s.step_median);
    text += '\n';
  }
  if (const auto tiles = fact(s, "device.tiles"))
    text += *tiles > 0.0 ? fmt::format("device  {} tiles on chip took the steps\n", *tiles)
                         : "device  launches took the steps\n";
  return text + fmt::format("result  {}\n", folder);
}

}  // namespace breccia
