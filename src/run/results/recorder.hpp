#pragma once
// Records of a run while it goes on: rows of history.csv, frames and pictures.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "domain/communicator.hpp"
#include "io/picture/picture.hpp"
#include "io/vtu/paraview.hpp"
#include "run/machine/background.hpp"
#include "run/machine/energy_watch.hpp"
#include "run/method/method.hpp"
#include "run/results/history.hpp"
#include "run/results/log.hpp"
#include "run/results/picture_notes.hpp"
#include "run/results/result_folder.hpp"
#include "run/results/step_table.hpp"
#include "run/results/summary.hpp"

namespace breccia {

/// The moments k end / count, k = 0, 1, 2, ...: something is due at the first step at or past one.
/// Which one is next follows from the time alone, so a resumed run meets the same steps.
class Schedule {
 public:
  /// Never, but for k = 0.
  Schedule() = default;
  Schedule(double end, double count) : end_(end), count_(count) {}

  double next() const { return next_; }
  /// The next moment becomes the first one later than `time`.
  void pass(double time);

 private:
  double end_ = std::numeric_limits<double>::infinity(), count_ = 1.0;
  double next_ = 0.0;  ///<  [s]
};

/// How far the record has come: what a checkpoint needs so that a resumed run leaves the same one.
struct RecordState {
  std::int64_t row_step = -1;      ///< of the last row that the schedule asked for
  std::int64_t frame_step = -1;    ///< of the last frame that the schedule asked for
  double frame_time = 0.0;         ///< likewise  [s]
  std::int64_t frames = 0;         ///< in the folder, that the schedule asked for
  std::optional<Extent> first;     ///< extent of the first picture  [m]
  std::optional<Extent> extent;    ///< of the last picture  [m]
  std::int64_t height = 0;         ///< of the pictures; 0: not known yet  [pixels]
  std::vector<ProbeRange> probes;  ///< over the rows that the schedule asked for
  EnergyWatch::Rows unbalanced;    ///< likewise
  double unbalanced_from = 0.0;    ///< EnergyWatch::began
  KineticShare moving;             ///< likewise

  void save(CheckpointWriter& writer) const;
  void load(const CheckpointReader& reader);
};

/// Writes what the case's [output] asks for. It only reads the method: no output changes a bit of
/// the run. Of several ranks each has one; that of rank 0 writes.
class Recorder {
 public:
  /// @param stages  of the case
  Recorder(const CaseConfig& config, const std::vector<StageEnd>& stages, Communicator* ranks);
  /// Goes on with an older record, which had come to that state.
  /// @param time, step  then  [s], [-]
  void resume(const RecordState& state, double time, std::int64_t step);
  /// Opens the files of a new record, or cuts those of an older one to its state. Rank 0 only.
  void open(const ResultFolder& folder, Log& log);

  /// Texts that every picture holds beside its own.
  void describe(std::vector<PngNote> notes) { notes_ = std::move(notes); }

  /// Whether a row, a frame or a picture is due. Cheap: asked every step.
  bool due(double time, std::int64_t step) const { return time >= next() || is_picture_step(step); }
  /// When the next row or frame is due.  [s]
  double next() const { return std::min(rows_.next(), frames_.next()); }
  /// The step after this one at which something is due, whatever the time.
  std::int64_t next_step(std::int64_t step) const;
  /// A row of steps.csv, if it is asked for.
  void note_step(const StepRow& row);
  /// Writes the rows, pictures and frames that are due; frames in the background where the method
  /// can be looked at there.
  void record(Method& method, Background& background);
  /// Draws pictures/stage_<name>.png, the state at the end of a stage, where there are pictures.
  std::function<void(const std::string& stage)> drawer(Method& method, Background& background);
  /// Writes a row and a frame of the last state, if the schedule did not ask for them.
  void record_last(Method& method, Background& background);
  /// At the end of a case. @throws NumericsError if its energies do not add up
  void judge_end(Method& method, const EnergyBalance& energy) const;
  /// Brings all files up to what was recorded. The background must have finished.
  void sync();

  /// To be saved after record() and before record_last().
  const RecordState& state() const { return state_; }
  /// The energies of the newest row, on rank 0; none before the first.
  const std::optional<EnergyBalance>& last_energy() const { return last_energy_; }
  /// How far the run was from quasi-static, by its rows; on rank 0.
  const KineticShare& moving() const { return state_.moving; }
  /// Frames written to the folder so far.
  std::int64_t frame_count() const { return frame_count_; }

 private:
  template <class Work>
  void naming_fastest(Method& method, const Work& work) const;
  void write_row(Method& method);
  void write_frame(Method& method, Then then, Background& background);
  void write_frame_of(Method& method, std::int64_t number, const PictureMoment& moment);
  void write_picture_beside_frames(Method& method, const std::string& name);
  RenderOptions picture_options() const;
  FrameWish wish_of_picture() const;
  /// Step, time and hash of the state, of all ranks together.
  static PictureMoment moment_of(Method& method);
  void write_picture(const std::string& name, const PictureMoment& moment,
                     const FrameOutput& output);
  bool is_picture_step(std::int64_t step) const;
  bool wants_frames() const { return config_.output.fields || config_.output.pictures; }

  CaseConfig config_;
  std::vector<StageEnd> stages_;
  Communicator* ranks_;
  RecordState state_;
  std::string pictures_;
  std::vector<PngNote> notes_;  ///< of the case
  Log* log_ = nullptr;
  std::optional<History> history_;
  std::optional<ParaviewSeries> series_;
  std::optional<StepTable> steps_;
  Schedule rows_, frames_;
  FrameFormat format_;
  std::vector<std::int64_t> picture_steps_;  ///< ascending
  std::int64_t frame_count_ = 0;
  std::optional<std::int64_t> resumed_from_;  ///< a step
  std::optional<EnergyBalance> last_energy_;
  EnergyWatch watch_;
  bool told_blank_ = false;
};

}  // namespace breccia
