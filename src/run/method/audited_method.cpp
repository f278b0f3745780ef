#include "run/method/audited_method.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/random.hpp"
#include "exec/error.hpp"

namespace breccia {
namespace {

class AuditedMethod final : public Method {
 public:
  AuditedMethod(std::unique_ptr<Method> method, std::int64_t every, std::int64_t seed,
                Communicator* ranks)
      : method_(std::move(method)),
        every_(every),
        draws_{static_cast<std::uint64_t>(seed), stream},
        ranks_(ranks) {}

  Advanced advance(const StopAt& stop) override {
    if (!next_) begin();
    if (steps() < *next_) {
      pushed_ = false;
      return method_->advance({stop.time, std::min(stop.step, *next_)});
    }
    if (std::exchange(pushed_, false)) {
      next_ = drawn_from(steps() + 1);
      return method_->advance(stop);
    }
    const Advanced taken = repeated(stop);
    next_ = drawn_from(steps());
    return taken;
  }

  std::int64_t steps() const override { return method_->steps(); }
  double time() const override { return method_->time(); }
  double time_step() const override { return method_->time_step(); }
  std::int64_t searches() const override { return method_->searches(); }
  std::vector<std::string> warnings() override { return method_->warnings(); }
  std::string step_rule() override { return method_->step_rule(); }
  std::vector<StageEnd> stages() const override { return method_->stages(); }
  StageProgress stage() const override { return method_->stage(); }
  void set_stage(const StageProgress& stage) override {
    left_.reset();
    method_->set_stage(stage);
  }
  EnergyBalance energy() override { return method_->energy(); }
  double rounding() const override { return method_->rounding(); }
  std::vector<double> probes() override { return method_->probes(); }
  void note_breaks() override {
    left_.reset();
    method_->note_breaks();
  }
  Row row() override {
    left_.reset();
    return method_->row();
  }
  std::uint64_t state_hash() override { return method_->state_hash(); }
  void verify() override { method_->verify(); }
  std::string fastest() override { return method_->fastest(); }
  Frame frame() override { return method_->frame(); }
  FrameOutput frame_output(const FrameWish& wish) override { return method_->frame_output(wish); }
  std::unique_ptr<Method> snapshot() override { return method_->snapshot(); }
  std::vector<Fact> facts() override {
    std::vector<Fact> facts = method_->facts();
    if (leads(ranks_)) facts.push_back({"audit.repeated_steps", static_cast<double>(repeated_)});
    return facts;
  }
  std::vector<StateArray> arrays(const std::string& name, Wanted wanted) override {
    left_.reset();  // whoever has them may write
    return method_->arrays(name, wanted);
  }
  /// A step with them is not repeated: they are of its caller, and no part of the state.
  void add_forces(const OwnForces& forces) override {
    left_.reset();
    method_->add_forces(forces);
    pushed_ = true;
  }
  double book_forces(const OwnForces& forces) override {
    left_.reset();
    return method_->book_forces(forces);
  }
  Index force_numbers() const override { return method_->force_numbers(); }
  Index force_items() const override { return method_->force_items(); }
  std::vector<Table> tables() override { return method_->tables(); }
  void save(CheckpointWriter& writer) override { method_->save(writer); }
  std::vector<std::string> constants() const override { return method_->constants(); }
  void load(const CheckpointReader* reader) override {
    method_->load(reader);
    next_.reset();
    left_.reset();
  }

 private:
  static constexpr std::uint32_t stream = 0x61756474;  ///< of random numbers

  /// How many steps are done when the next one is repeated: `step` to `step` + 2 `every` - 2, each
  /// as likely.
  std::int64_t drawn_from(std::int64_t step) const {
    const double share = draws_.uniform(static_cast<std::uint64_t>(step));
    return step + static_cast<std::int64_t>(share * static_cast<double>(2 * every_ - 1));
  }

  void begin() {
    CheckpointWriter now;
    method_->save(now);
    constants_ = now.digests(method_->constants());
    next_ = drawn_from(steps());
  }

  /// A constant that has changed would be wrong in both results alike. Rank 0 looks.
  void require_constants(const CheckpointWriter& now) const {
    for (const auto& [name, found] : now.digests(method_->constants()))
      if (found != constants_.at(name))
        throw DeviceError(fmt::format(
            "before step {}: the array {} has changed, though no step changes it: memory or "
            "processor of this machine fails, or the program does; resume from the newest "
            "checkpoint on another machine",
            steps() + 1, name));
  }

  /// Throws if the state has changed since the last repeated step. Rank 0 looks.
  void require_untouched(const CheckpointWriter& now) const {
    if (!left_ || left_at_ != steps()) return;
    if (const std::string difference = left_->first_difference(now); !difference.empty())
      throw DeviceError(fmt::format(
          "after step {}: the state has changed between two steps ({}): memory of this machine "
          "fails, or the program does; resume from the newest checkpoint on another machine",
          steps(), difference));
  }

  Advanced repeated(const StopAt& stop) {
    CheckpointWriter before, first, second;
    method_->save(before);
    on_first(ranks_, [&] {
      require_constants(before);
      require_untouched(before);
    });
    left_.reset();
    const std::int64_t from = steps();
    const Advanced taken = method_->advance({stop.time, from + 1});
    const std::int64_t to = steps();
    const std::uint64_t first_hash = method_->state_hash();
    method_->save(first);

    std::optional<CheckpointReader> kept;
    if (leads(ranks_)) kept.emplace(before);
    method_->load(kept ? &*kept : nullptr);
    while (steps() < to && method_->advance({stop.time, to}).steps > 0) {
    }
    const std::uint64_t second_hash = method_->state_hash();
    method_->save(second);
    on_first(ranks_, [&] {
      const std::string difference = first.first_difference(second);
      if (steps() == to && first_hash == second_hash && difference.empty()) return;
      throw DeviceError(fmt::format(
          "step {} was done twice, with different results (state {:016x}, then {:016x}; {}): "
          "memory or processor of this machine fails, or the program does; resume from the newest "
          "checkpoint on another machine",
          to, first_hash, second_hash, difference));
    });
    repeated_ += to - from;
    left_ = std::move(second);
    left_at_ = to;
    return taken;
  }

  std::unique_ptr<Method> method_;
  std::int64_t every_;
  Random draws_;
  Communicator* ranks_;
  std::optional<std::int64_t> next_;         ///< steps that are done when one is repeated
  std::map<std::string, Digest> constants_;  ///< sections that never change; on rank 0
  std::optional<CheckpointWriter> left_;     ///< the state after a repeated step; on rank 0
  std::int64_t left_at_ = 0;                 ///< that step
  std::int64_t repeated_ = 0;
  bool pushed_ = false;  ///< forces of the caller act in the step to come
};

}  // namespace

std::unique_ptr<Method> audited(std::unique_ptr<Method> method, const AuditConfig& audit,
                                std::int64_t seed, Communicator* ranks) {
  if (audit.every == 0) return method;
  return std::make_unique<AuditedMethod>(std::move(method), audit.every, seed, ranks);
}

}  // namespace breccia
