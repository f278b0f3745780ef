#pragma once
// A world that a run steps and observes, on one rank or shared out among many.
//
// Every rank makes the same calls. What is seen often, each rank finds in its part, and rank 0 puts
// it together; what is saved is brought together on rank 0 first. Either way rank 0 alone gets the
// result, with the same bytes for any number of ranks.

#include <algorithm>
#include <new>
#include <optional>
#include <utility>

#include "core/rare_array.hpp"
#include "core/step_clock.hpp"
#include "domain/domain.hpp"
#include "exec/device.hpp"
#include "run/method/method.hpp"

namespace breccia {

/// @tparam World  with advance, rebalance, share_out and collect beside it
template <class World>
class SharedWorld {
 public:
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
    if (ranks_ != nullptr) share();
  }

  /// Makes a copy of something that holds this, where that may be looked at while this one goes on:
  /// on a device, alone, with memory left: for the copy, and a quarter of that for the searches of
  /// this one meanwhile. Otherwise null.
  template <class Copy>
  auto apart(const Copy& copy) -> decltype(copy()) {
    if (ranks_ != nullptr || space_ == Space::host) return nullptr;
    try {
      auto made = copy();
      release(space_, allocate(space_, bytes_kept() / 4));
      wait_for_device();
      return made;
    } catch (const std::bad_alloc&) {
      return nullptr;
    }
  }
  /// Of a copy: what it does is not booked.
  void forget_timers() { whole_.exec.timers = nullptr; }

  Communicator* ranks() const { return ranks_; }
  /// The world that steps: a rank's part of it.
  World& part() { return part_ ? *part_ : whole_; }
  const World& part() const { return part_ ? *part_ : whole_; }
  /// All of it, where only what never changes is as it is now. Rank 0 only.
  const World& mesh() const { return whole_; }
  /// Calls work(world) for all of it, and for a rank's part: for what the case says of both.
  template <class Work>
  void in_both(const Work& work) {
    work(whole_);
    if (part_) work(*part_);
    stale_ = part_.has_value();
  }
  /// Calls work(world) for what steps: a change of its own that the whole learns of later.
  template <class Work>
  void in_part(const Work& work) {
    work(part());
    stale_ = part_.has_value();
  }
  /// The global ledger, without contributions that ranks have not reported yet. Rank 0
  /// only.
  auto& ledger() { return whole_.ledger; }

  /// Brings all of it together on rank 0, and calls work(whole) there.
  template <class Work>
  void with_whole(const Work& work) {
    if (stale_) {
      at_once(ranks_, [&] {
        collect(*part_, whole_);
        facts_ = domain_facts(*ranks_, part_->domain.counts, waited_);
      });
      stale_ = false;
    }
    on_first(ranks_, [&] { work(whole_); });
  }
  /// The result of query(whole) on rank 0; on others an empty one.
  template <class Query>
  auto of_whole(const Query& query) {
    decltype(query(whole_)) seen{};
    with_whole([&](World& whole) { seen = query(whole); });
    return seen;
  }
  /// Rank 0 gives the whole world another state, of which the others get their parts.
  template <class Work>
  void renew(const Work& work) {
    on_first(ranks_, [&] { work(whole_); });
    if (ranks_ != nullptr) share();
  }
  /// The messages of all ranks, by rank; on others than rank 0 none.
  std::vector<Message> told(Message message) {
    std::vector<Message> messages;
    at_once(ranks_, [&] { messages = told_to_first(*ranks_, std::move(message)); });
    return messages;
  }
  /// How the ranks fare, as of the last look at the whole; nothing to tell of one.
  void add_facts(std::vector<Fact>& facts) const {
    if (ranks_ == nullptr) return;
    facts.insert(facts.end(), {{"domain.sharings", static_cast<double>(facts_.migrations)},
                               {"domain.cuts", static_cast<double>(facts_.cuts)},
                               {"domain.moved", static_cast<double>(facts_.moved)},
                               {"domain.copies", facts_.ghosts},
                               {"domain.imbalance", facts_.imbalance},
                               {"domain.waited_s.least", facts_.waited_least},
                               {"domain.waited_s.mean", facts_.waited_mean},
                               {"domain.waited_s.most", facts_.waited_most}});
  }

  /// Alone as many steps as advance() takes at one go; on ranks all of them.
  Advanced advance_to(const StopAt& stop) {
    if (ranks_ == nullptr) return advance(whole_, stop);
    Advanced taken;
    at_once(ranks_, [&] { taken = advance_part(stop); });
    return taken;
  }
  /// Around steps of a rank's part: ranks share elements out anew where these fared unevenly.
  void begin_steps() {
    stale_ = true;  // also of a state with wrong numbers
    waited_before_ = ranks_->waited();
    rebalance(*part_);  // before steps: output sees the forces of contacts, which do not migrate
    part_->domain.pace.resume(*ranks_);
  }
  void end_steps() {
    part_->domain.pace.pause(*ranks_);
    waited_ += ranks_->waited() - waited_before_;
  }

 private:
  std::size_t bytes_kept() {
    std::size_t bytes = 0;
    whole_.each_kept([&](const auto& array) {
      using Array = std::remove_cvref_t<decltype(array)>;
      if constexpr (is_rare<Array>)
        bytes += at(array.size()) * sizeof(Index) +
                 at(array.records()) * sizeof(typename Array::value_type);
      else if constexpr (requires { array.size() * sizeof(typename Array::value_type); })
        bytes += at(array.size()) * sizeof(typename Array::value_type);
    });
    return bytes;
  }
  template <class Make>
  static World made(const Make& make, Exec exec, Communicator* ranks, const DomainConfig& config) {
    if (ranks != nullptr) ranks->set_patience(config.patience);
    if (ranks != nullptr) exec.space = Space::host;
    std::optional<World> world;
    collective_try(ranks, [&] { world.emplace(make(exec)); });
    return std::move(*world);
  }
  Advanced advance_part(const StopAt& stop) {
    World& w = *part_;
    begin_steps();
    Advanced taken;
    do {
      const Advanced more = advance(w, stop);
      taken.dt_min = taken.steps == 0 ? more.dt_min : std::min(taken.dt_min, more.dt_min);
      taken.dt_max = std::max(taken.dt_max, more.dt_max);
      taken.steps += more.steps;
    } while (w.step < stop.step && w.time < stop.time);
    end_steps();
    return taken;
  }
  void share() {
    at_once(ranks_, [&] {
      part_.emplace(share_out(whole_, *ranks_, config_, space_));
      whole_.domain.partition = part_->domain.partition;
      facts_ = domain_facts(*ranks_, part_->domain.counts, waited_);
      if (ranks_->rank() != 0) drop_state(whole_);
    });
    stale_ = false;
  }

  Communicator* ranks_;
  DomainConfig config_;
  Space space_;  ///< of the part that steps
  World whole_;
  std::optional<World> part_;
  bool stale_ = false;
  DomainFacts facts_;
  double waited_ = 0.0;         ///< for other ranks, in steps  [s]
  double waited_before_ = 0.0;  ///< when the present ones began  [s]
};

}  // namespace breccia
