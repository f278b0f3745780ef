#pragma once
// Runs of the program side by side, each a process of its own.

#include <functional>
#include <string>
#include <vector>

namespace breccia::laboratory {

/// A run that is wanted.
struct PlannedRun {
  std::string name;                    ///< in lines of progress and in tables
  std::string case_path;               ///< as `breccia run` takes it
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::string folder;                  ///< of its results
  std::string digest;                  ///< of the completed case: what finished runs are known by
};

/// Outcome of the run.
struct FinishedRun {
  int exit_code = 0;     ///< of the program; 9: done, but a check of the case failed
  bool kept = false;     ///< was finished before; nothing was computed
  double wall = 0.0;     ///< wall-clock time spent on it now  [s]
  std::string message;   ///< the error, if it has failed
  int again_beside = 0;  ///< > 0: it lacked memory, and will run again, so many at a time

  /// Whether its numbers count.
  bool complete() const { return exit_code == 0 || exit_code == 9; }
  /// Whether it ended without an error of its own: all there is to know is in its log.
  bool ended_mute() const;
};

/// Where a run of that folder leaves what it says.
std::string log_beside(const std::string& folder);

/// Where a run computes.
struct Device {
  std::string name;     ///< as the option of `breccia run`
  std::string visible;  ///< the GPUs that its ranks share, CUDA_VISIBLE_DEVICES; empty: all
};

/// Resources that the runs share.
struct Workers {
  int jobs = 1;                   ///< runs at a time
  int ranks = 1;                  ///< of each run, by mpirun if there are several
  int threads = 1;                ///< of each rank
  std::vector<Device> devices;    ///< a run takes the one with the fewest runs; none: processors
  bool force = false;             ///< compute finished runs anew
  bool allow_scripts = false;     ///< as the option of `breccia run`
  std::string program;            ///< empty: this one
  std::string mpirun = "mpirun";  ///< of the MPI that the program is built with
};

/// How many runs fit beside each other: at most one rank a core and as many as the memory holds.
/// Each rank has one thread, or its share of the cores if not every core has a rank.
/// @param asked  runs at a time, of one thread each; 0: as many as fit
/// @param bytes  of memory that the model of the largest run takes; each rank builds all of it
/// @param ranks  of each run
Workers workers_for(int asked, std::size_t runs, double bytes, int ranks = 1);

/// The GPUs dealt to runs: one each, or as many as a run has ranks, or all where there are fewer.
/// @param there    GPUs
/// @param visible  their names by CUDA_VISIBLE_DEVICES; empty: by number
std::vector<Device> gpus_for(int there, int ranks, const std::string& visible);

/// Makes the runs, in their order, as many at a time as there are workers. A folder that holds the
/// finished run of the same completed case is kept; one whose run was interrupted goes on from its
/// newest checkpoint; anything else there is computed anew. A failing run stops no other. What a
/// run says goes to FOLDER.log beside its folder, which is removed when the run is complete.
///
/// A run that ends for want of memory, or by SIGKILL, as others run beside it is made again, with
/// fewer at a time from then on; one that was alone has failed.
///
/// SIGINT, SIGTERM and SIGUSR1 are handed to the runs, which save their states, and no further run
/// begins; the runs that were not made have exit code 128 + the number of the signal.
///
/// @param tell  called for each run as it ends, and as it is put off for want of memory: its number
///              and what became of it
/// @throws IoError if a folder cannot be made or no process can be started
std::vector<FinishedRun> run_side_by_side(
    const std::vector<PlannedRun>& runs, const Workers& workers,
    const std::function<void(std::size_t, const FinishedRun&)>& tell);

}  // namespace breccia::laboratory
