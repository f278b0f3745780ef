#pragma once
// The outer loop: step, observe, save, until the end or a signal.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "exec/timers.hpp"
#include "run/background.hpp"
#include "run/checkpoints.hpp"
#include "run/log.hpp"
#include "run/method.hpp"
#include "run/progress.hpp"
#include "run/recorder.hpp"
#include "run/result_folder.hpp"
#include "run/step_times.hpp"
#include "run/summary.hpp"

namespace breccia {

/// Where a run ends if not at the end of its case: --until and --steps.
struct Limits {
  std::optional<double> time;         ///< simulated time  [s]
  std::optional<std::int64_t> steps;  ///< since the start of the case
};

/// What a run is told besides its method.
struct RunPlan {
  CaseConfig config;
  std::string case_name;    ///< for people
  std::string case_text;    ///< the completed case file
  std::string case_digest;  ///< of case_text
  std::string case_folder;  ///< where files that the case names are
  std::string prepared;     ///< file of the prepared model; empty: built from the case
  /// Of what decides the states of the run; a checkpoint of another one is refused.
  std::string model_digest;
  Limits limits;
  Machine machine;
  StageTimers* timers = nullptr;  ///< what the method books its stages in
  std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  Speech speech = Speech::normal;
  Progress::Form progress = Progress::Form::none;
};

/// One run of a method in a result folder.
class Run {
 public:
  /// A new run of the method as it is, from its start or from a state it has loaded.
  Run(Method& method, const RunPlan& plan, const ResultFolder& folder);
  /// Goes on with the run of the folder: loads the checkpoint into the method, cuts the record to
  /// it. @throws CheckpointError if it is of another case
  Run(Method& method, const RunPlan& plan, const ResultFolder& folder,
      const CheckpointReader& checkpoint);

  /// Steps to the end. Returns 0, or 128 + n after signal n, the state then being saved.
  /// @throws NumericsError after saving the state as crash.br; IoError; CheckFailed if a check of
  ///         the case fails. summary.json then tells of it.
  int execute();

 private:
  using Clock = std::chrono::steady_clock;

  void start();
  int advance();
  StopAt next_stop() const;
  void take_steps();
  void observe();
  bool finished() const;
  double share() const;
  void save_checkpoint();
  /// All of a checkpoint but the method's own.
  CheckpointWriter record_state() const;
  int interrupted(int signal);
  int done();
  void failed(int exit_code, const std::string& message);
  /// What went wrong, with step, time and element, where the search or a law that met it knew none.
  std::string located(const std::string& error);
  std::string save_crash();
  Summary summary() const;
  Summary measured() const;
  void describe_state(Summary& summary) const;
  void write_summary(const Summary& summary) const;
  void tell_in_place(const Summary& summary) const;
  void say(const std::string& text);
  Standing standing();

  Method& method_;
  const RunPlan& plan_;
  const ResultFolder& folder_;
  double end_time_;                     ///< the run ends at the first step at or past it  [s]
  std::int64_t end_steps_;              ///< likewise
  double dt_min_ = 0.0, dt_max_ = 0.0;  ///<  [s]
  Log log_;
  Recorder recorder_;
  Checkpoints checkpoints_;
  StepTimes step_times_;
  Progress progress_;
  double setup_ = 0.0, loop_ = 0.0, output_ = 0.0;  ///< wall time  [s]
  std::string broken_;
  Clock::time_point next_facts_{};
  Background background_;  ///< last: it uses the others
};

/// The state that a run of `plan` would go on from. @throws CheckpointError if it is of another
/// case
void refuse_other_case(const CheckpointReader& checkpoint, const RunPlan& plan);

}  // namespace breccia
