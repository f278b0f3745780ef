#pragma once
// A world that a run steps and observes, on one rank or shared out among many.
//
// Rank 0 leads: it alone runs the outer loop, and tells the others what to do with it. What is seen
// often it asks of all ranks, each of which answers for its part. What is saved is brought together
// on it first. Either way everything that a run writes has the same bytes for any number of ranks.

#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <new>
#include <optional>

#include "core/step_clock.hpp"
#include "domain/domain.hpp"
#include "exec/device.hpp"
#include "exec/error.hpp"

namespace breccia {

/// @tparam World  with advance, rebalance, share_out and collect beside it
template <class World>
class SharedWorld {
 public:
  /// What a rank has to say of its part when it is asked.
  using Answer = std::function<Message(World& part, const Message& question)>;

  /// @param make   builds the whole world where it is told to; may fail
  /// @param exec   of the world that steps; the whole of many parts lies on the host
  /// @param ranks  null: alone. Otherwise every rank makes one of these from the same case.
  template <class Make>
  SharedWorld(const Make& make, const Exec& exec, Communicator* ranks, const DomainConfig& config)
      : ranks_(ranks),
        config_(config),
        space_(exec.space),
        whole_(made(make, exec, ranks, config)) {
    whole_.domain.config = config;  // frames read it
    if (ranks_ != nullptr) at_once([&] { share(); });
  }

  /// Makes a copy of something that holds this, where that may be looked at while this one goes on:
  /// on a device, alone, with memory left. Otherwise null.
  template <class Copy>
  auto apart(const Copy& copy) const -> decltype(copy()) {
    if (ranks_ != nullptr || space_ == Space::host) return nullptr;
    try {
      auto made = copy();
      wait_for_device();
      return made;
    } catch (const std::bad_alloc&) {
      return nullptr;
    }
  }
  /// Of a copy: what it does is not booked.
  void forget_timers() { whole_.exec.timers = nullptr; }

  bool alone() const { return ranks_ == nullptr; }
  /// The world that steps: a rank's part of it.
  const World& part() const { return part_ ? *part_ : whole_; }
  /// All of it, as of now. Rank 0 only.
  World& whole() {
    if (ranks_ != nullptr && stale_) {
      command(Command::collect);
      at_once([&] { bring_together(); });
      stale_ = false;
    }
    return whole_;
  }
  /// All of it, where only what never changes is as it is now. Rank 0 only.
  const World& mesh() const { return whole_; }
  /// What has been booked for good, but for what parts have booked since they told last. Rank 0
  /// only.
  auto& ledger() { return whole_.ledger; }
  /// What each rank has to say of its part as it is now, by rank. Rank 0 of several only.
  /// @param question  goes to all ranks; no longer than it need be
  /// @param answer    the same as follow() takes on the others
  std::vector<Message> ask(const Message& question, const Answer& answer) {
    command(Command::answer, question);
    std::vector<Message> answers;
    at_once([&] { answers = told_to_first(answer(*part_, question)); });
    return answers;
  }
  /// How the ranks fare, as of the last look at the whole; nothing to tell of one.
  template <class Add>
  void add_facts(const Add& add) const {
    if (ranks_ == nullptr) return;
    add("domain.sharings", static_cast<double>(facts_.migrations));
    add("domain.cuts", static_cast<double>(facts_.cuts));
    add("domain.moved", static_cast<double>(facts_.moved));
    add("domain.copies", facts_.copies);
    add("domain.imbalance", facts_.imbalance);
    add("domain.waited_s.least", facts_.waited_least);
    add("domain.waited_s.mean", facts_.waited_mean);
    add("domain.waited_s.most", facts_.waited_most);
  }

  /// On the host of several ranks a few steps at a time: what they are told costs a message.
  Advanced advance_to(StopAt stop) {
    if (ranks_ == nullptr) return advance(whole_, stop);
    constexpr double attention = 0.02;  // time between two looks at signals and progress  [s]
    const auto begin = std::chrono::steady_clock::now();
    stop.step = std::min(stop.step, part_->step + steps_at_once_);
    Message until(sizeof stop);
    std::memcpy(until.data(), &stop, sizeof stop);
    command(Command::advance, until);
    stale_ = true;
    Advanced taken;
    at_once([&] { taken = advance_part(stop); });
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    if (spent.count() < 0.5 * attention)
      steps_at_once_ = std::min<std::int64_t>(2 * steps_at_once_, 1000);
    if (spent.count() > attention) steps_at_once_ = std::max<std::int64_t>(steps_at_once_ / 2, 1);
    return taken;
  }
  /// After the whole world has got another state: the others get their parts of it.
  void share_again() {
    command(Command::share);
    if (ranks_ != nullptr) at_once([&] { share(); });
    stale_ = false;
  }

  /// Ranks other than 0: does what rank 0 commands. Returns the exit code that it ends with.
  int follow(const Answer& answer) {
    while (true) {
      Message message = ranks_->from_first({});
      const auto command = static_cast<Command>(message.at(0));
      if (command == Command::stop) return static_cast<int>(message.at(1));
      message.erase(message.begin());
      try {
        at_once([&] {
          if (command == Command::advance) {
            StopAt stop;
            std::memcpy(&stop, message.data(), sizeof stop);
            advance_part(stop);
          }
          if (command == Command::answer) told_to_first(answer(*part_, message));
          if (command == Command::collect) bring_together();
          if (command == Command::share) share();
        });
      } catch (const Error&) {
        // If all ranks have thrown it, rank 0 tells of it and decides what comes next.
        if (!ranks_->in_step()) throw;
      }
    }
  }
  /// Rank 0: the others end with this exit code, if they can still be reached.
  void dismiss(int exit_code) {
    if (ranks_ == nullptr || !ranks_->in_step()) return;
    ranks_->from_first({static_cast<std::byte>(Command::stop), static_cast<std::byte>(exit_code)});
  }

 private:
  template <class Make>
  static World made(const Make& make, Exec exec, Communicator* ranks, const DomainConfig& config) {
    if (ranks != nullptr) ranks->set_patience(config.patience);
    if (ranks != nullptr) exec.space = Space::host;
    std::optional<World> world;
    together_or_not(ranks, [&] { world.emplace(make(exec)); });
    return std::move(*world);
  }
  /// Work that all ranks do: one that fails alone leaves the others waiting.
  template <class Work>
  void at_once(const Work& work) {
    if (ranks_ == nullptr) return work();
    ranks_->set_in_step(false);
    work();
    ranks_->set_in_step(true);
  }

  enum class Command : std::uint8_t { advance, answer, collect, share, stop };

  void command(Command command, const Message& more = {}) {
    if (ranks_ == nullptr) return;
    Message message{static_cast<std::byte>(command)};
    message.insert(message.end(), more.begin(), more.end());
    ranks_->from_first(std::move(message));
  }
  /// The messages of all ranks on rank 0, on others none.
  std::vector<Message> told_to_first(Message message) {
    std::vector<Message> messages(static_cast<std::size_t>(ranks_->size()));
    messages[0] = std::move(message);
    return ranks_->exchange(std::move(messages));
  }
  Advanced advance_part(const StopAt& stop) {
    World& w = *part_;
    const double waited_before = ranks_->waited();
    w.domain.pace.resume(*ranks_);
    Advanced taken;
    do {
      const Advanced more = advance(w, stop);
      taken.dt_min = taken.steps == 0 ? more.dt_min : std::min(taken.dt_min, more.dt_min);
      taken.dt_max = std::max(taken.dt_max, more.dt_max);
      taken.steps += more.steps;
    } while (w.step < stop.step && w.time < stop.time);
    w.domain.pace.pause(*ranks_);
    rebalance(w);
    waited_ += ranks_->waited() - waited_before;
    return taken;
  }
  void bring_together() {
    collect(*part_, whole_);
    facts_ = domain_facts(*ranks_, part_->domain.counts, waited_);
  }
  void share() {
    part_.emplace(share_out(whole_, *ranks_, config_, space_));
    whole_.domain.partition = part_->domain.partition;
    facts_ = domain_facts(*ranks_, part_->domain.counts, waited_);
    if (ranks_->rank() != 0) drop_state(whole_);
  }

  Communicator* ranks_;
  DomainConfig config_;
  Space space_;  ///< of the part that steps
  World whole_;
  std::optional<World> part_;
  bool stale_ = false;
  DomainFacts facts_;
  double waited_ = 0.0;  ///< for other ranks, in steps  [s]
  std::int64_t steps_at_once_ = 1;
};

}  // namespace breccia
