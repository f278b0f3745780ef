#pragma once
// When the stages of a case end, and the next ones begin.

#include <functional>
#include <string>
#include <vector>

#include "core/case_config.hpp"
#include "domain/communicator.hpp"
#include "run/method/method.hpp"
#include "run/results/summary.hpp"

namespace breccia {

/// Looks between steps at whether a stage is over. It looks by step numbers and simulated time
/// alone, so that threads, ranks and a resumed run find the same ends. Every rank has one; rank 0
/// decides.
class StageControl {
 public:
  /// @param last  name of the stage that the run ends with; empty: the last one
  /// @throws InputError if there is no such stage
  StageControl(Method& method, const std::vector<ProbeConfig>& probes, const std::string& last,
               Communicator* ranks);

  /// Whether the stage that the run ends with is over. Never without stages.
  bool finished() const;
  /// Whether the last stage of the case is over. Never without stages.
  bool all_over() const;
  /// Begins the next stage, where a former run ended with the one before.
  void go_on();
  /// When the run ends at the latest: at `end`, or with the last of stages that all end by time.
  /// [s]
  double end_by_time(double end) const;
  /// Whether a stage to come may end before its `until`: at rest, or by a probe.
  bool may_end_early() const;
  /// `stop`, or the next look before it.
  StopAt limited(StopAt stop) const;
  /// Ends the present stage and begins the next, if it is time. Returns what happened, in words.
  /// @param at_end  is told the name of a stage that has ended, before the next one changes
  /// anything
  std::vector<std::string> look(const std::function<void(const std::string&)>& at_end = {});
  /// Stages that have begun.
  std::vector<StageRecord> records() const;

 private:
  const StageEnd& present() const { return stages_[at(method_.stage().index)]; }
  static std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }
  bool is_look(std::int64_t step) const;
  StageCause cause_to_end(StageProgress& progress);
  double probe_of(const std::vector<double>& values, const std::string& name) const;

  Method& method_;
  std::vector<StageEnd> stages_;
  std::vector<std::string> probes_;
  std::size_t last_ = 0;
  Communicator* ranks_;
};

}  // namespace breccia
