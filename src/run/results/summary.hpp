#pragma once
// summary.json: what a run was and what came out, for scripts.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/energy.hpp"
#include "run/machine/machine.hpp"
#include "run/method/method.hpp"

namespace breccia {

/// A number the case stated, and what the run showed.
struct CheckResult {
  std::string name;
  std::optional<double> value;  ///< none: the run has no such number
  double expected = 0.0, tolerance = 0.0;
  std::string unit;
  bool pass = false;
};

/// A stage that a run came to.
struct StageRecord {
  std::string name;
  double begin = 0.0, end = 0.0;  ///<  [s]
  std::string ended_by;           ///< time, rest, probe or drop; empty: it goes on
};

/// The newest, smallest and largest value of a probe over the rows of history.csv.
struct ProbeRange {
  std::string name;
  double last = 0.0, min = 0.0, max = 0.0;
};

/// Everything in summary.json. What does not apply stays empty and is left out.
struct Summary {
  std::string status = "running";  ///< done, running, failed or interrupted
  int exit_code = 0;
  std::string message;
  std::vector<std::string> warnings;  ///< of set-up

  std::string case_name, case_sha256, method, precision;
  std::int64_t seed = 0;
  Machine machine;

  std::int64_t steps = 0;
  double time = 0.0;                                          ///<  [s]
  double dt_min = 0.0, dt_max = 0.0, dt_last = 0.0;           ///<  [s]
  std::string dt_rule;                                        ///< what rules it; may be empty
  double total = 0.0, setup = 0.0, loop = 0.0, output = 0.0;  ///< wall time  [s]
  double step_median = 0.0, step_p95 = 0.0;                   ///<  [us]
  std::map<std::string, double> stages;                       ///<  [s]
  std::int64_t peak_memory = 0;                               ///<  [bytes]

  std::vector<Fact> facts;
  std::optional<EnergyBalance> energy;
  double kinetic_share = 0.0;  ///< largest kinetic energy over the largest work  [-]
  std::optional<std::uint64_t> state_hash;
  std::vector<ProbeRange> probes;
  std::vector<CheckResult> checks;
  std::vector<StageRecord> stages_of_case;
};

/// The text of summary.json; its numbers read back to the same bits.
std::string to_json(const Summary& summary);

/// The number at a path such as "energy.kinetic" in summary.json, or "probe.<name>.<last|min|max>".
std::optional<double> number_at(const Summary& summary, const std::string& path);

}  // namespace breccia
