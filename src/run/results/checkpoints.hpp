#pragma once
// The checkpoints of a run: when one is due, how many are kept, which one a run goes on from.

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/case_config.hpp"
#include "io/checkpoint.hpp"

namespace breccia {

/// The files checkpoints/step_<number>.br of a result folder.
class Checkpoints {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Checkpoints(const CheckpointConfig& config) : config_(config) {}
  /// Where they are written. @throws IoError if the folder cannot be made
  void open(const std::string& folder);

  /// Whether any is kept; if not, none is due or written, and the run cannot be resumed.
  bool wanted() const { return config_.keep > 0; }

  /// Whether the state after `step` is to be saved, by steps or by wall time.
  bool due(std::int64_t step, Clock::time_point now) const;

  /// The first step after `step` at which one is due by steps.
  std::int64_t next_step(std::int64_t step) const;

  /// The next file is of this step. Returns its path.
  std::string begin(std::int64_t step);
  /// Writes that state, verifies it, then removes the oldest beyond those to keep.
  /// @throws IoError; the older checkpoints are then all there
  void write(std::int64_t step, const CheckpointWriter& state) const;

  /// The line that tells how a run that was cut short goes on in `folder`; empty where none is
  /// kept.
  std::string way_on(const std::string& folder) const;

  /// The step of the newest checkpoint that was begun, -1 if none.
  std::int64_t last_step() const { return last_step_; }

 private:
  std::string path(std::int64_t step) const;

  std::string folder_;
  CheckpointConfig config_;
  std::int64_t last_step_ = -1;
  Clock::time_point last_time_ = Clock::now();
};

/// A checkpoint file and the step its name tells.
struct CheckpointFile {
  std::string path;
  std::int64_t step;
};

/// Checkpoints of a folder `checkpoints`, newest first.
std::vector<CheckpointFile> list_checkpoints(const std::string& folder);

/// Reads the newest checkpoint that is whole; tells `warn` about each damaged one it passes by.
/// @throws CheckpointError if there is none
CheckpointReader newest_good_checkpoint(const std::string& folder,
                                        const std::function<void(const std::string&)>& warn);

}  // namespace breccia
