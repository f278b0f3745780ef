#pragma once
// The outer loop: step, observe, save, until the end or a signal.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "exec/timers.hpp"
#include "run/machine/background.hpp"
#include "run/method/method.hpp"
#include "run/results/checkpoints.hpp"
#include "run/results/log.hpp"
#include "run/results/progress.hpp"
#include "run/results/recorder.hpp"
#include "run/results/result_folder.hpp"
#include "run/results/step_times.hpp"
#include "run/results/summary.hpp"
#include "run/stage_control.hpp"

namespace breccia {

/// Exit code of a run that --max-wall ended: its state is saved, `resume` goes on.
inline constexpr int exit_at_wall_limit = 10;

/// Where a run ends if not at the end of its case: --until, --steps and --max-wall.
struct Limits {
  std::optional<double> time;         ///< simulated time  [s]
  std::optional<std::int64_t> steps;  ///< since the start of the case
  std::optional<double> wall{};       ///< since the program began: then saved, to be resumed  [s]
  std::string stage{};                ///< ends with this stage; empty: with the case
};

/// Plan of a run, besides its method.
struct RunPlan {
  CaseConfig config;
  std::string case_name;              ///< for people
  std::string case_text;              ///< the completed case file
  std::string case_digest;            ///< of case_text
  std::string case_folder;            ///< where files that the case names are
  std::string prepared;               ///< file of the prepared model; empty: built from the case
  std::vector<std::string> warnings;  ///< about the case
  /// Of what decides the states of the run; a checkpoint of another one is refused.
  std::string model_digest;
  Limits limits;
  bool ends_anew = false;  ///< time.end was given for this run, whatever the run before was sent to
  Machine machine;
  StageTimers* timers = nullptr;  ///< what the method books its stages in
  Communicator* ranks = nullptr;  ///< that share the work; null: none
  std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  Speech speech = Speech::normal;
  Progress::Form progress = Progress::Form::none;
};

/// How far a run had come when a checkpoint was written; the method's state is apart from it.
struct RunState {
  std::int64_t step;
  double time;             ///<  [s]
  double dt_min, dt_max;   ///<  [s]
  double end_time;         ///< where it was sent  [s]
  std::int64_t end_steps;  ///< likewise
  RecordState record;

  explicit RunState(const CheckpointReader& checkpoint);
};

/// One run of a method in a result folder. Of several ranks each executes the same run: rank 0
/// writes files, speaks, and decides what depends on its clock or on signals.
class Run {
 public:
  /// A run of the method as it is, from its start or from a state that it has loaded.
  /// @param folder  null on ranks other than 0
  /// @param former  not null: goes on with the run of the folder, whose record is cut to that state
  Run(Method& method, const RunPlan& plan, const ResultFolder* folder,
      const RunState* former = nullptr);

  /// Steps to the end. Returns 0, or 128 + n after signal n, the state then being saved.
  /// @throws NumericsError after saving the state as crash.br; IoError; CheckFailed if a check of
  ///         the case fails. summary.json then tells of it. All ranks throw it, unless
  ///         thrown_by_all() tells otherwise.
  int execute();

 private:
  using Clock = std::chrono::steady_clock;
  /// Decisions of rank 0 between two steps, for all ranks.
  struct Decision {
    std::int64_t steps_at_once = 1;              ///< of several ranks, to the next decision
    std::int32_t signal = 0;                     ///< ends the run; 0: none
    std::int32_t save = 0, show = 0, count = 0;  ///< checkpoint, progress, new facts for it
  };

  void go_on_from(const RunState& former);
  int execute_together();
  void start();
  int advance();
  StopAt next_stop() const;
  double take_steps();
  Decision decide(double spent) const;
  void observe();
  bool finished() const {
    return method_.time() >= end_time_ || method_.steps() >= end_steps_ || stages_.finished();
  }
  bool is_whole_case() const {
    return method_.time() >= plan_.config.time.end || stages_.all_over();
  }
  double share() const {
    const double end = stages_.end_by_time(end_time_);
    const double by_time = end > 0.0 ? method_.time() / end : 1.0;
    const double by_steps = static_cast<double>(method_.steps()) / static_cast<double>(end_steps_);
    return std::clamp(std::max(by_time, by_steps), 0.0, 1.0);
  }
  void save_checkpoint(Then then);
  /// All of a checkpoint but the method's own.
  CheckpointWriter record_state() const;
  int interrupted(int cause);
  int done();
  void conclude(Summary& now);
  void failed(int exit_code, const std::string& message);
  /// The error with step, time and element, where the search or a law that met it knew none.
  std::string located(const std::string& error);
  std::string save_crash();
  Summary summary() const;
  Summary measured() const;
  void describe_state(Summary& summary) const;
  void write_summary(const Summary& summary) const;
  void tell_in_place(const Summary& summary) const;
  void say(const std::string& text);
  void count_broken();
  Standing standing() const;
  bool out_of_time() const;

  Method& method_;
  const RunPlan& plan_;
  const ResultFolder* folder_;          ///< null on ranks other than 0
  double end_time_;                     ///< the run ends at the first step at or past it  [s]
  std::int64_t end_steps_;              ///< likewise
  double dt_min_ = 0.0, dt_max_ = 0.0;  ///<  [s]
  std::optional<Log> log_;              ///< likewise
  Recorder recorder_;
  Checkpoints checkpoints_;
  StepTimes step_times_;
  StageControl stages_;
  Progress progress_;
  std::int64_t steps_at_once_ = 1;
  double setup_ = 0.0, loop_ = 0.0, output_ = 0.0;      ///< wall time  [s]
  double save_time_ = 0.0;                              ///< of the longest checkpoint so far  [s]
  std::vector<std::string> warnings_ = plan_.warnings;  ///< of set-up
  std::string broken_;
  Clock::time_point next_facts_{};
  Background background_;  ///< last: it uses the others
};

/// The state that a run of `plan` would go on from. @throws CheckpointError if it is of another
/// case
void refuse_other_case(const CheckpointReader& checkpoint, const RunPlan& plan);

}  // namespace breccia
