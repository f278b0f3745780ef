#include "run/method/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/emphasis.hpp"
#include "run/results/history.hpp"

namespace breccia {

namespace {

/// The number that a check compares: from the summary, or with `.at` from rows of history.csv.
std::optional<double> value_of(const CheckConfig& check, const Summary& summary,
                               const std::string& history) {
  if (check.at < 0.0) return number_at(summary, check.value);
  for (std::size_t k = 0; k < summary.probes.size(); ++k)
    if (check.value == "probe." + summary.probes[k].name + ".at")
      return History::probe_at(history, k, check.at);
  return std::nullopt;
}

}  // namespace

std::vector<CheckResult> evaluate_checks(const std::vector<CheckConfig>& checks,
                                         const Summary& summary, const std::string& history) {
  std::vector<CheckResult> results;
  for (const CheckConfig& check : checks) {
    CheckResult result{check.name,     value_of(check, summary, history),
                       check.expected, check.tolerance,
                       check.unit,     false};
    // Not a number compares false, so it never passes.
    result.pass = result.value && std::abs(*result.value - check.expected) <= check.tolerance;
    results.push_back(std::move(result));
  }
  return results;
}

bool all_pass(const std::vector<CheckResult>& results) {
  return std::all_of(results.begin(), results.end(), [](const CheckResult& r) { return r.pass; });
}

std::string check_table(const std::vector<CheckResult>& results) {
  std::size_t width = 4;
  for (const CheckResult& result : results) width = std::max(width, result.name.size());
  std::string table = fmt::format("  {:<{}}  {:>13}  {:>13}  {:>9}  {:<4}\n", "check", width,
                                  "value", "expected", "tolerance", "unit");
  for (const CheckResult& result : results)
    table += fmt::format("  {:<{}}  {:>13}  {:>13.8g}  {:>9.4g}  {:<4}  {}\n", result.name, width,
                         result.value ? fmt::format("{:.8g}", *result.value) : "missing",
                         result.expected, result.tolerance, result.unit,
                         result.pass ? emphasized(Emphasis::good, "pass", stdout)
                                     : emphasized(Emphasis::error, "FAIL", stdout));
  return table;
}

}  // namespace breccia
