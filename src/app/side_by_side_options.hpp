#pragma once
// The options of commands that make many runs side by side.

#include <functional>
#include <string>
#include <vector>

#include "laboratory/side_by_side.hpp"
#include "run/case.hpp"

namespace CLI {
class App;
}

namespace breccia::app {

struct SideBySideOptions {
  int jobs = 0;     ///< 0: as many as there are cores and memory for
  int ranks = 1;    ///< of each run
  int threads = 0;  ///< of each rank; 0: its share of the cores
  std::string device = "cpu";
  bool force = false, allow_scripts = false;

  /// @param bytes  of memory that the largest run takes
  laboratory::Workers workers(std::size_t runs, double bytes) const;
};

void add_side_by_side_options(CLI::App& command, SideBySideOptions& options);

/// The problem of a text that must be a count of runs or seeds; empty if there is none.
std::string count_problem(const std::string& text);

/// Memory that a run of the case takes at least.  [bytes]
double run_bytes(const Case& read);

/// Notes on a case (Case::notes), told by a command before its runs begin.
void tell_notes(const std::vector<std::string>& notes);

/// Tells of each run as it ends: how many have ended, how, in which time, and its name.
std::function<void(std::size_t, const laboratory::FinishedRun&)> tell_of(
    const std::vector<laboratory::PlannedRun>& runs);

}  // namespace breccia::app
