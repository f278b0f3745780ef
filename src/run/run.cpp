#include "run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <new>

#include "domain/together.hpp"
#include "exec/error.hpp"
#include "io/file.hpp"
#include "io/fold.hpp"
#include "io/harmless.hpp"
#include "io/whole_file.hpp"
#include "run/machine/signals.hpp"
#include "run/method/checks.hpp"
#include "run/method/doubts.hpp"
#include "run/results/messages.hpp"
#include "run/results/tables.hpp"

namespace breccia {
namespace {

/// Steps from one look at the numbers to the next.
constexpr std::int64_t verify_every = 1000;

/// Why a run ends early, beside the numbers of signals.
constexpr int wall_limit = -1;

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Books the time from its construction to its end as output, and only as output: what the method
/// books in its stages meanwhile is not part of a step.
class OutputTime {
 public:
  OutputTime(StageTimers* timers, double& output) : timers_(timers), output_(output) {
    if (timers_ != nullptr) stages_ = *timers_;
  }
  OutputTime(const OutputTime&) = delete;
  OutputTime& operator=(const OutputTime&) = delete;
  ~OutputTime() {
    if (timers_ != nullptr) *timers_ = stages_;
    output_ += seconds_since(begin_);
  }

 private:
  StageTimers* timers_;
  StageTimers stages_;
  double& output_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

Run::Run(Method& method, const RunPlan& plan, const ResultFolder* folder, const RunState* former)
    : method_(method),
      plan_(plan),
      folder_(folder),
      end_time_(plan.limits.time.value_or(plan.config.time.end)),
      end_steps_(plan.limits.steps.value_or(std::numeric_limits<std::int64_t>::max())),
      recorder_(plan.config, method.stages(), plan.ranks),
      checkpoints_(plan.config.checkpoint),
      stages_(method, plan.config.probes, plan.limits.stage, plan.ranks),
      progress_(stdout, plan.progress) {
  if (former != nullptr) go_on_from(*former);
  on_first(plan_.ranks, [&] {
    const std::string log = folder_->file("log.jsonl");
    if (former != nullptr) Log::cut_to(log, former->step);
    log_.emplace(log, plan_.speech == Speech::verbose ? stdout : nullptr);
    recorder_.describe(notes_of_case(plan_.case_name, plan_.case_text,
                                     static_cast<std::int64_t>(plan_.config.seed)));
    recorder_.open(*folder_, *log_);
    checkpoints_.open(folder_->file("checkpoints"));
  });
}

void Run::go_on_from(const RunState& former) {
  dt_min_ = former.dt_min;
  dt_max_ = former.dt_max;
  recorder_.resume(former.record, former.time, former.step);
  // A run that was cut short goes on to where it was sent; one that got there, or that is told
  // where to end, goes on to the end of its case.
  const bool cut_short = former.time < former.end_time && former.step < former.end_steps;
  if (!cut_short || plan_.ends_anew || plan_.limits.time || plan_.limits.steps) return;
  end_time_ = former.end_time;
  end_steps_ = former.end_steps;
}

int Run::execute() {
  // Until its end each rank may fail alone, and then ends the others.
  int exit_code = 0;
  at_once(plan_.ranks, [&] { exit_code = execute_together(); });
  return exit_code;
}

int Run::execute_together() {
  try {
    start();
    const int signal = advance();
    return signal != 0 ? interrupted(signal) : done();
  } catch (const NumericsError& error) {
    const std::string message = fmt::format("{}\n  {}", located(error.what()), save_crash());
    failed(error.exit_code(), message);
    throw NumericsError(message);
  } catch (const CheckFailed&) {
    throw;  // the run itself ended well and told so
  } catch (const Error& error) {
    failed(error.exit_code(), error.what());
    throw;
  } catch (const std::bad_alloc&) {
    const DeviceError error(fmt::format("not enough memory at step {}", method_.steps()));
    failed(error.exit_code(), error.what());
    if (!thrown_by_all(plan_.ranks)) throw;
    throw error;
  }
}

void Run::start() {
  setup_ = seconds_since(plan_.begin);
  const bool to_end = !plan_.limits.time && !plan_.limits.steps;
  for (const std::string& doubt : doubts_of(method_, to_end ? plan_.config.time.end : 1e300))
    warnings_.push_back(doubt);
  const Summary now = summary();
  on_first(plan_.ranks, [&] {
    write_summary(now);
    replace_durably(folder_->file("case.toml"), plan_.case_text);
    log_->write(Level::info, "setup", method_.steps(),
                fmt::format("{} starts at step {}, {:.9g} s", plan_.case_name, method_.steps(),
                            method_.time()));
    say(opening_text(now, {stages_.end_by_time(end_time_), end_steps_, stages_.may_end_early()},
                     folder_->path()));
    for (const std::string& warning : warnings_) log_->warn_once("setup", method_.steps(), warning);
  });
  method_.verify();
  if (recorder_.due(method_.time(), method_.steps())) observe();
  broken_ = broken_text(now.facts);
  progress_.start(standing());
}

/// Returns the signal that ended the loop, 0 if it got to its end.
int Run::advance() {
  if (!finished()) stages_.go_on();
  while (!finished()) {
    const double spent = take_steps();
    if (recorder_.due(method_.time(), method_.steps())) observe();
    for (const std::string& text : stages_.look(recorder_.drawer(method_, background_)))
      on_first(plan_.ranks, [&] { log_->write(Level::info, "stage", method_.steps(), text); });
    const Decision decision = decide(spent);
    steps_at_once_ = decision.steps_at_once;
    if (decision.signal != 0) return decision.signal;
    if (decision.save != 0) save_checkpoint(Then::steps);
    if (decision.count != 0) count_broken();
    if (decision.show != 0) progress_.show(standing(), Clock::now());
  }
  return 0;
}

/// The next thing to do, as rank 0 finds: clocks and signals differ from rank to rank.
/// @param spent  wall time of the last steps  [s]
Run::Decision Run::decide(double spent) const {
  constexpr double attention = 0.02;  // of several ranks, between two decisions  [s]
  const Clock::time_point now = Clock::now();
  Decision decision;
  decision.steps_at_once = steps_at_once_;
  if (spent < 0.5 * attention)
    decision.steps_at_once = std::min<std::int64_t>(2 * steps_at_once_, 1000);
  if (spent > attention) decision.steps_at_once = std::max<std::int64_t>(steps_at_once_ / 2, 1);
  decision.signal = finished() ? 0 : StopSignals::received();
  if (decision.signal == 0 && !finished() && out_of_time()) decision.signal = wall_limit;
  decision.save = !finished() && checkpoints_.due(method_.steps(), now) ? 1 : 0;
  decision.show = progress_.due(share(), now) ? 1 : 0;
  decision.count = decision.show != 0 && now >= next_facts_ ? 1 : 0;
  if (plan_.ranks != nullptr) take_from_first(*plan_.ranks, decision);
  return decision;
}

/// The next moment at which someone looks at the state, or at which ranks decide.
StopAt Run::next_stop() const {
  const std::int64_t now = method_.steps(), look = (now / verify_every + 1) * verify_every;
  StopAt stop{std::min(end_time_, recorder_.next()),
              std::min({end_steps_, look, checkpoints_.next_step(now), recorder_.next_step(now)})};
  if (plan_.ranks != nullptr) stop.step = std::min(stop.step, now + steps_at_once_);
  return stages_.limited(stop);
}

/// Returns the wall time that they took.  [s]
double Run::take_steps() {
  const std::int64_t searches = method_.searches();
  const Clock::time_point begin = Clock::now();
  const Advanced taken = method_.advance(next_stop());
  const double spent = seconds_since(begin);
  if (taken.steps == 0) return spent;
  recorder_.note_step({method_.steps(), method_.time(), spent, method_.searches() - searches});
  step_times_.add(spent / static_cast<double>(taken.steps), taken.steps);
  loop_ += spent;
  dt_min_ = dt_min_ > 0.0 ? std::min(dt_min_, taken.dt_min) : taken.dt_min;
  dt_max_ = std::max(dt_max_, taken.dt_max);
  if (method_.steps() % verify_every == 0) method_.verify();
  return spent;
}

void Run::observe() {
  const OutputTime time(plan_.timers, output_);
  recorder_.record(method_, background_);
}

CheckpointWriter Run::record_state() const {
  CheckpointWriter writer(CheckpointWriter::Arrays::left);  // it is written before the next step
  writer.value("run.step", method_.steps());
  writer.value("run.time", method_.time());
  writer.value("run.dt_min", dt_min_);
  writer.value("run.dt_max", dt_max_);
  writer.value("run.end_time", end_time_);
  writer.value("run.end_steps", end_steps_);
  writer.text("run.method", plan_.config.method);
  writer.text("run.precision", plan_.config.precision);
  writer.text("run.case_name", plan_.case_name);
  writer.text("run.case_folder", plan_.case_folder);
  if (!plan_.prepared.empty()) writer.text("run.prepared", plan_.prepared);
  writer.text("run.model_digest", plan_.model_digest);
  writer.text("run.case", plan_.case_text);
  recorder_.state().save(writer);
  return writer;
}

void Run::save_checkpoint(Then then) {
  if (!checkpoints_.wanted() || checkpoints_.last_step() == method_.steps()) return;
  const Clock::time_point begin = Clock::now();
  const OutputTime time(plan_.timers, output_);
  method_.verify();
  const std::int64_t step = method_.steps();
  const std::string path = checkpoints_.begin(step);
  on_first(plan_.ranks, [&] { background_.finish(); });  // pictures note what they show
  const auto state = std::make_shared<CheckpointWriter>(record_state());
  on_first(plan_.ranks, [&] {
    recorder_.sync();
    log_->write(Level::info, "checkpoint", step, path);
  });
  if (const std::shared_ptr<Method> later = snapshot_of(method_, then)) {
    background_.add([this, later, state, step] {
      later->save(*state);
      checkpoints_.write(step, *state);
    });
  } else {
    method_.save(*state);
    on_first(plan_.ranks, [&] { checkpoints_.write(step, *state); });
  }
  const Summary now = summary();
  on_first(plan_.ranks, [&] {
    log_->sync();
    write_summary(now);
  });
  save_time_ = std::max(save_time_, seconds_since(begin));
}

/// Whether what is left of the wall limit is no more than what saving may take.
bool Run::out_of_time() const {
  if (!plan_.limits.wall) return false;
  const double needed = 1.0 + 2.0 * save_time_;
  return seconds_since(plan_.begin) >=
         *plan_.limits.wall - std::min(needed, 0.1 * *plan_.limits.wall);
}

int Run::interrupted(int cause) {
  save_checkpoint(Then::end);
  background_.finish();
  Summary now = summary();
  now.energy = method_.energy();
  now.status = "interrupted";
  now.exit_code = cause == wall_limit ? exit_at_wall_limit : 128 + cause;
  now.message = fmt::format(
      "{} at step {}; {}", cause == wall_limit ? "end of --max-wall" : signal_name(cause),
      method_.steps(), checkpoints_.wanted() ? "state saved" : "no state saved, as asked");
  on_first(plan_.ranks, [&] {
    log_->write(Level::warning, "end", method_.steps(), now.message);
    write_summary(now);
    progress_.end_line();
    say(fmt::format("{}\n{}", now.message, checkpoints_.way_on(folder_->path())));
  });
  return now.exit_code;
}

int Run::done() {
  save_checkpoint(Then::end);
  {
    const OutputTime time(plan_.timers, output_);
    recorder_.record_last(method_, background_);
    const std::vector<Table> tables = method_.tables();
    on_first(plan_.ranks, [&] {
      background_.finish();
      recorder_.sync();
      for (const Table& table : tables)
        replace_durably(folder_->file(table.name + ".csv"), to_csv(table));
    });
  }
  Summary now = summary();
  if (!now.energy) now.energy = method_.energy();  // resumed at its end: no row was written
  if (is_whole_case()) recorder_.judge_end(method_, *now.energy);
  on_first(plan_.ranks, [&] { conclude(now); });
  return 0;
}

/// Tells what came out. @throws CheckFailed
void Run::conclude(Summary& now) {
  now.status = "done";
  const bool whole_case = is_whole_case();
  for (const std::string& doubt :
       {inertia_text(plan_.config.time.mass_scaling, now.kinetic_share),
        whole_case ? unbegun_text(method_.stages(), method_.stage().index) : std::string()})
    if (!doubt.empty()) log_->warn("end", method_.steps(), doubt), now.warnings.push_back(doubt);
  if (whole_case)
    now.checks = evaluate_checks(plan_.config.checks, now, folder_->file("history.csv"));
  const std::string table = now.checks.empty() ? "" : check_table(now.checks);
  if (!all_pass(now.checks)) {
    now.status = "failed";
    now.exit_code = CheckFailed("").exit_code();
    now.message = "a check of the case failed";
  }
  log_->write(now.exit_code == 0 ? Level::info : Level::error, "end", method_.steps(),
              now.exit_code == 0 ? "done" : now.message);
  write_summary(now);
  broken_ = broken_text(now.facts);
  if (progress_.due(1.0, Clock::time_point::max())) progress_.show(standing(), Clock::now());
  progress_.end_line();
  say(closing_text(now, recorder_.frame_count(), folder_->path()));
  if (now.exit_code != 0)
    throw CheckFailed(fmt::format("{} ({})\n{}", now.message, folder_->path(), table));
  if (!plan_.config.checks.empty())
    say(whole_case ? table : "checks  not made: the run ends before the end of its case\n");
}

/// Rank 0 writes what it can of a failure. Where that fails, too, the first one is the one to tell.
void Run::failed(int exit_code, const std::string& message) {
  const auto write = [this](const auto& work) {
    if (folder_ == nullptr) return true;
    try {
      work();
    } catch (const std::exception&) {
      return false;
    }
    return true;
  };
  // Without memory or a device arrays may be half made: kernels would read beyond their ends.
  const bool of_all = thrown_by_all(plan_.ranks) && exit_code != DeviceError("").exit_code();
  at_once(plan_.ranks, [&] {
    progress_.end_line();
    write([&] {
      background_.finish();
      recorder_.sync();
    });
    write([&] { log_->write(Level::error, "end", method_.steps(), message); });
    Summary now = measured();
    try {
      if (of_all) {
        describe_state(now);
        now.energy = method_.energy();
        if (!is_finite(*now.energy)) now.energy.reset();
      }
    } catch (const std::exception&) {
      // Numbers that went wrong, or no memory, may leave no energy: the summary then lacks it.
      if (!thrown_by_all(plan_.ranks)) throw;
    }
    now.status = "failed";
    now.exit_code = exit_code;
    now.message = message;
    if (!write([&] { write_summary(now); })) tell_in_place(now);
  });
}

/// A full disk has no room for a second summary, but the first must not say that all is well.
void Run::tell_in_place(const Summary& now) const {
  try {
    overwrite(folder_->file("summary.json"), bytes_of(to_json(now)));
  } catch (const Error&) {
  }
}

std::string Run::located(const std::string& error) {
  if (error.starts_with("step ")) return error;
  try {
    if (thrown_by_all(plan_.ranks)) at_once(plan_.ranks, [&] { method_.verify(); });
  } catch (const NumericsError& precise) {
    return precise.what();
  } catch (const Error&) {
    if (!thrown_by_all(plan_.ranks)) throw;
  }
  return fmt::format("step {}, t = {:.6e} s: {}", method_.steps(), method_.time(), error);
}

/// Saves the state with the wrong numbers; returns a sentence about it.
std::string Run::save_crash() {
  try {
    CheckpointWriter state;
    at_once(plan_.ranks, [&] {
      state = record_state();
      method_.save(state);
    });
    if (folder_ == nullptr) return "";
    const std::string path = folder_->file("crash.br");
    state.write(path);
    return fmt::format("state written to {0} (open with 'breccia info {0}')", path);
  } catch (const std::exception& error) {
    if (!thrown_by_all(plan_.ranks)) throw;
    return fmt::format("the state could not be saved: {}", error.what());
  }
}

Summary Run::summary() const {
  Summary s = measured();
  describe_state(s);
  // Asking the ledger may note a new largest energy in it, so it is asked at rows only: when a
  // checkpoint falls due by wall time must not show in the history.
  s.energy = recorder_.last_energy();
  s.kinetic_share = recorder_.moving().value();
  return s;
}

Summary Run::measured() const {
  Summary s;
  s.case_name = plan_.case_name;
  s.case_sha256 = plan_.case_digest;
  s.method = plan_.config.method;
  s.precision = plan_.config.precision;
  s.seed = plan_.config.seed;
  s.warnings = warnings_;
  s.stages_of_case = stages_.records();
  s.machine = plan_.machine;
  s.steps = method_.steps();
  s.time = method_.time();
  s.dt_min = dt_min_;
  s.dt_max = dt_max_;
  s.dt_last = method_.time_step();
  s.total = seconds_since(plan_.begin);
  s.setup = setup_;
  s.loop = loop_;
  s.output = output_;
  s.step_median = 1e6 * step_times_.quantile(0.5);
  s.step_p95 = 1e6 * step_times_.quantile(0.95);
  if (plan_.timers != nullptr)
    for (const auto& [name, entry] : plan_.timers->stages()) s.stages[name] = entry.seconds;
  s.peak_memory = peak_memory();
  if (recorder_.state().row_step >= 0) s.probes = recorder_.state().probes;
  return s;
}

void Run::describe_state(Summary& s) const {
  s.facts = method_.facts();
  s.state_hash = method_.state_hash();
  s.dt_rule = method_.step_rule();
}

void Run::write_summary(const Summary& summary) const {
  replace_durably(folder_->file("summary.json"), to_json(summary));
}

void Run::say(const std::string& text) {
  if (plan_.speech == Speech::quiet) return;
  std::fputs(fitting(harmless(text), 8, stdout).c_str(), stdout);  // behind the words at the left
  std::fflush(stdout);
}

void Run::count_broken() {
  // Counting may cost more than many steps: spend at most a hundredth of the time on it.
  const Clock::time_point begin = Clock::now();
  broken_ = broken_text(method_.facts());
  next_facts_ = Clock::now() + 100 * (Clock::now() - begin);
}

Standing Run::standing() const {
  const std::optional<EnergyBalance> row = recorder_.last_energy();
  std::optional<double> missing;
  if (row) missing = row->error_relative;
  return {method_.steps(), method_.time(), share(), broken_, missing};
}

}  // namespace breccia
