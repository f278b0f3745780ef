#include "domain/simulated_ranks.hpp"

#include <condition_variable>
#include <cstring>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <tuple>

#include "core/state_hash.hpp"

namespace breccia {
namespace {

struct RanksLost : std::runtime_error {
  RanksLost() : std::runtime_error("another simulated rank has failed") {}
};

/// Carries the messages: they lie in flight until a rank that waits lets random ones arrive. A rank
/// sleeps only if nothing is in flight, and wakes when its message has arrived: wakes cost more
/// than the steps of small scenes.
class Carrier {
 public:
  Carrier(std::uint64_t seed, int ranks)
      : sleepers_(static_cast<std::size_t>(ranks)), random_(seed) {}

  using Address = std::tuple<int, int, std::int64_t>;  // from, to, number of the operation

  /// Nobody wakes: the sender delivers when it waits itself, or when it leaves.
  void post(const Address& address, Message message) {
    const std::lock_guard lock(mutex_);
    in_flight_.emplace_back(address, std::move(message));
  }
  Message wait_for(const Address& address) {
    std::unique_lock lock(mutex_);
    Sleeper& self = sleepers_[static_cast<std::size_t>(std::get<1>(address))];
    while (true) {
      const auto found = arrived_.find(address);
      if (found != arrived_.end()) {
        Message message = std::move(found->second);
        arrived_.erase(found);
        return message;
      }
      if (failed_) throw RanksLost();
      if (in_flight_.empty()) {
        self.waits_for = address;
        self.wake.wait(lock);
        self.waits_for.reset();
      } else {
        deliver_one();
      }
    }
  }
  /// A rank has come to its end: what it sent arrives.
  void leave() {
    const std::lock_guard lock(mutex_);
    while (!in_flight_.empty()) deliver_one();
  }
  void fail() {
    const std::lock_guard lock(mutex_);
    failed_ = true;
    for (Sleeper& sleeper : sleepers_) sleeper.wake.notify_one();
  }

 private:
  struct Sleeper {
    std::condition_variable wake;
    std::optional<Address> waits_for;
  };

  void deliver_one() {
    random_ += 0x9e3779b97f4a7c15ULL;
    const std::size_t i = mixed(random_) % in_flight_.size();
    const Address address = in_flight_[i].first;
    arrived_.insert(std::move(in_flight_[i]));
    in_flight_[i] = std::move(in_flight_.back());
    in_flight_.pop_back();
    Sleeper& to = sleepers_[static_cast<std::size_t>(std::get<1>(address))];
    if (to.waits_for == address) to.wake.notify_one();
  }

  std::mutex mutex_;
  std::vector<Sleeper> sleepers_;  ///< of each rank
  std::vector<std::pair<Address, Message>> in_flight_;
  std::map<Address, Message> arrived_;
  std::uint64_t random_;
  bool failed_ = false;
};

class SimulatedRank final : public Communicator {
 public:
  SimulatedRank(Carrier& carrier, int rank, int size)
      : carrier_(carrier), rank_(rank), size_(size) {}

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  std::unique_ptr<RepeatedMessages> prepare(const std::vector<Post>& to,
                                            const std::vector<Post>& from) override {
    return std::make_unique<Repeated>(*this, to, from);
  }
  std::vector<Message> exchange(std::vector<Message> messages) override {
    ++operation_;
    for (int r = 0; r < size_; ++r)
      carrier_.post({rank_, r, operation_}, std::move(messages[static_cast<std::size_t>(r)]));
    std::vector<Message> came;
    for (int r = 0; r < size_; ++r) came.push_back(carrier_.wait_for({r, rank_, operation_}));
    return came;
  }
  void abort(int) override { throw std::runtime_error("a simulated rank ends all"); }

 private:
  class Repeated final : public RepeatedMessages {
   public:
    Repeated(SimulatedRank& rank, const std::vector<Post>& to, const std::vector<Post>& from)
        : self_(rank), to_(to), from_(from) {}
    void start() override {
      operation_ = ++self_.operation_;
      for (const Post& post : to_) {
        const auto* bytes = static_cast<const std::byte*>(post.data);
        self_.carrier_.post({self_.rank_, post.rank, operation_},
                            Message(bytes, bytes + post.bytes));
      }
    }
    void finish() override {
      for (const Post& post : from_) {
        const Message message = self_.carrier_.wait_for({post.rank, self_.rank_, operation_});
        if (message.size() != post.bytes)
          throw std::logic_error("a message has another size than its receiver expects");
        if (post.bytes > 0) std::memcpy(post.data, message.data(), post.bytes);
      }
    }

   private:
    SimulatedRank& self_;
    std::vector<Post> to_, from_;
    std::int64_t operation_ = 0;  ///< the last that was started
  };

  Carrier& carrier_;
  int rank_, size_;
  std::int64_t operation_ = 0;
};

}  // namespace

void simulate_ranks(int count, std::uint64_t seed,
                    const std::function<void(Communicator&)>& rank_main) {
  Carrier carrier(seed, count);
  std::exception_ptr first;
  std::mutex mutex;
  std::vector<std::thread> threads;
  for (int r = 0; r < count; ++r)
    threads.emplace_back([&, r] {
      SimulatedRank rank(carrier, r, count);
      try {
        rank_main(rank);
        carrier.leave();
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!first) first = std::current_exception();
        carrier.fail();
      }
    });
  for (std::thread& thread : threads) thread.join();
  if (first) std::rethrow_exception(first);
}

}  // namespace breccia
