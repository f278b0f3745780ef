#include "run/stage_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/named.hpp"
#include "domain/together.hpp"
#include "exec/error.hpp"

namespace breccia {
namespace {

constexpr std::int64_t look_every = 100;  ///< steps, at what must be counted
constexpr int looks_at_rest = 10;

}  // namespace

StageControl::StageControl(Method& method, const std::vector<ProbeConfig>& probes,
                           const std::string& last, Communicator* ranks)
    : method_(method), stages_(method.stages()), probes_(names_of(probes)), ranks_(ranks) {
  if (!stages_.empty()) last_ = stages_.size() - 1;
  if (last.empty()) return;
  const std::vector<std::string> names = names_of(stages_);
  std::vector<std::string> problems;
  add_unknown("--stage", last, "stage of the case", names, problems);
  if (!problems.empty()) throw InputError(problems.front() + "; nothing was run");
  last_ = static_cast<std::size_t>(std::find(names.begin(), names.end(), last) - names.begin());
}

bool StageControl::finished() const {
  return !stages_.empty() && method_.stage().over(last_);
}

bool StageControl::all_over() const {
  return !stages_.empty() && method_.stage().over(stages_.size() - 1);
}

void StageControl::go_on() {
  if (stages_.empty()) return;
  StageProgress progress = method_.stage();
  if (!progress.over() || at(progress.index) + 1 >= stages_.size()) return;
  ++progress.index;
  progress.calm = 0;
  progress.peak = 0.0;
  progress.begin[at(progress.index)] = method_.time();
  method_.set_stage(progress);
}

bool StageControl::is_look(std::int64_t step) const {
  const StageEnd& s = present();
  return step % look_every == 0 && (s.rest > 0.0 || s.drop > 0.0 || !s.when.empty());
}

double StageControl::end_by_time(double end) const {
  if (stages_.empty()) return end;
  const StageProgress progress = method_.stage();
  std::size_t k = at(progress.index);
  double sum = progress.over() ? progress.end[k++] : progress.begin[k];
  for (; k <= last_; ++k) {
    if (!(stages_[k].until > 0.0)) return end;
    sum += stages_[k].until;
  }
  return std::min(sum, end);
}

bool StageControl::may_end_early() const {
  for (std::size_t k = at(method_.stage().index); k < stages_.size() && k <= last_; ++k)
    if (stages_[k].rest > 0.0 || stages_[k].drop > 0.0 || !stages_[k].when.empty()) return true;
  return false;
}

StopAt StageControl::limited(StopAt stop) const {
  if (stages_.empty() || method_.stage().over()) return stop;
  const StageEnd& s = present();
  const StageProgress progress = method_.stage();
  if (s.until > 0.0) stop.time = std::min(stop.time, progress.begin[at(progress.index)] + s.until);
  if (s.rest > 0.0 || s.drop > 0.0 || !s.when.empty())
    stop.step = std::min(stop.step, (method_.steps() / look_every + 1) * look_every);
  return stop;
}

double StageControl::probe_of(const std::vector<double>& values, const std::string& name) const {
  const auto found = std::find(probes_.begin(), probes_.end(), name);
  return values[static_cast<std::size_t>(found - probes_.begin())];
}

/// Of rank 0; all ranks call it.
StageCause StageControl::cause_to_end(StageProgress& progress) {
  const StageEnd& s = present();
  StageCause cause = StageCause::none;
  if (is_look(method_.steps())) {
    EnergyBalance energy;
    std::vector<double> values;
    if (s.rest > 0.0) energy = method_.energy();
    if (s.drop > 0.0 || !s.when.empty()) values = method_.probes();
    on_first(ranks_, [&] {
      if (s.drop > 0.0) {
        const double size = std::abs(probe_of(values, s.drop_of));
        progress.peak = std::max(progress.peak, size);
        if (progress.peak > 0.0 && size <= (1.0 - s.drop) * progress.peak) cause = StageCause::drop;
      }
      if (!s.when.empty()) {
        const ProbeRule rule = *ProbeRule::parsed(s.when);
        if (rule.holds(probe_of(values, rule.probe))) cause = StageCause::probe;
      }
      if (s.rest > 0.0) {
        const bool calm = energy.elastic > 0.0 && energy.kinetic <= s.rest * energy.elastic;
        progress.calm = calm ? progress.calm + 1 : 0;
        if (progress.calm >= looks_at_rest) cause = StageCause::rest;
      }
    });
  }
  if (s.until > 0.0 && method_.time() >= progress.begin[at(progress.index)] + s.until)
    cause = StageCause::time;
  return cause;
}

std::vector<std::string> StageControl::look(const std::function<void(const std::string&)>& at_end) {
  if (stages_.empty()) return {};
  StageProgress progress = method_.stage();
  if (progress.over()) return {};
  const bool in_time = present().until > 0.0 &&
                       method_.time() >= progress.begin[at(progress.index)] + present().until;
  if (!in_time && !is_look(method_.steps())) return {};
  progress.cause[at(progress.index)] = cause_to_end(progress);
  if (ranks_ != nullptr) at_once(ranks_, [&] { take_from_first(*ranks_, progress); });
  const bool over = progress.over();
  if (over) progress.end[at(progress.index)] = method_.time();
  method_.set_stage(progress);
  if (!over) return {};
  if (at_end) at_end(present().name);
  std::vector<std::string> told{fmt::format("stage {} ends by {} at {:.9g} s", present().name,
                                            word_of(progress.cause[at(progress.index)]),
                                            method_.time())};
  if (finished()) return told;
  go_on();
  told.push_back(fmt::format("stage {} begins at {:.9g} s", present().name, method_.time()));
  return told;
}

std::vector<StageRecord> StageControl::records() const {
  std::vector<StageRecord> records;
  if (stages_.empty()) return records;
  const StageProgress progress = method_.stage();
  for (std::size_t k = 0; k <= at(progress.index); ++k)
    records.push_back(
        {stages_[k].name, progress.begin[k], progress.end[k], word_of(progress.cause[k])});
  return records;
}

}  // namespace breccia
