#pragma once
// The options that `run` and `resume` share, and what they mean.

#include <optional>
#include <string>
#include <vector>

#include "exec/space.hpp"
#include "run/case.hpp"
#include "run/run.hpp"

namespace CLI {
class App;
}

namespace breccia::app {

struct RunOptions {
  std::string device = "cpu";
  int threads = 0;  ///< 0: all there are
  std::optional<std::int64_t> steps;
  std::optional<double> until;  ///<  [s]
  std::string max_wall;         ///< as people write it; empty: none
  std::string stage;            ///< that the run ends with; empty: the last one
  std::vector<std::string> overrides;
  bool allow_scripts = false;
  bool quiet = false, verbose = false, no_progress = false;
};

void add_run_options(CLI::App& command, RunOptions& options);

/// The plan of a run of the case; `timers` are those the method books its stages in.
RunPlan plan_of(const Case& read, const RunOptions& options, const Exec& exec, Communicator* ranks);

}  // namespace breccia::app
