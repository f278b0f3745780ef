#pragma once
// A case states the numbers it must show; here they are held against what the run showed.

#include <string>
#include <vector>

#include "core/case_config.hpp"
#include "run/results/summary.hpp"

namespace breccia {

/// Every check of the case against the summary, and of a probe at a time against history.csv. A
/// number that the run does not have fails.
std::vector<CheckResult> evaluate_checks(const std::vector<CheckConfig>& checks,
                                         const Summary& summary, const std::string& history);

bool all_pass(const std::vector<CheckResult>& results);

/// The results as a table for people.
std::string check_table(const std::vector<CheckResult>& results);

}  // namespace breccia
