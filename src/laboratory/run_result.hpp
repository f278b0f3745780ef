#pragma once
// Results in the folder of a run, as numbers by name.

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace breccia::laboratory {

/// A check of the case, and what the run showed.
struct CheckedNumber {
  std::string name, unit;
  std::optional<double> value;
  double expected = 0.0, tolerance = 0.0;
  bool pass = false;
};

struct RunResult {
  std::string status;  ///< done, running, failed, interrupted
  int exit_code = 0;
  std::string digest;                     ///< of the completed case
  std::string message;                    ///< the error, if there was one
  std::map<std::string, double> numbers;  ///< of summary.json by their paths
  std::vector<CheckedNumber> checks;
  std::vector<std::string> probes;

  /// Whether the run came to the end of its case.
  bool complete() const { return exit_code == 9 || (status == "done" && exit_code == 0); }

  /// A number by its path in summary.json; "probe.NAME.peak" is the one of the probe's min and max
  /// that is farther from zero, and the name of a check is its value.
  std::optional<double> number(const std::string& path) const;
};

/// Nothing if the folder holds no readable summary.json.
std::optional<RunResult> read_result(const std::string& folder);

}  // namespace breccia::laboratory
