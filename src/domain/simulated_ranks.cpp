#include "domain/simulated_ranks.hpp"

#include <condition_variable>
#include <cstring>
#include <exception>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "core/state_hash.hpp"

namespace breccia {
namespace {

struct RanksLost : std::runtime_error {
  RanksLost() : std::runtime_error("another simulated rank has failed") {}
};

/// Carries the messages: they lie in flight until a rank that waits lets random ones arrive. A rank
/// sleeps only if nothing is in flight, and wakes when all that it waits for has arrived: wakes
/// cost more than the steps of small scenes.
class Carrier {
 public:
  Carrier(std::uint64_t seed, int ranks)
      : inboxes_(static_cast<std::size_t>(ranks)), random_(seed) {}

  struct Address {
    int from, to;
    std::int64_t operation;  ///< number of the operation
  };

  /// Nobody wakes: the sender delivers when it waits itself, or when it leaves.
  void post(const Address& address, Message message) {
    const std::lock_guard lock(mutex_);
    in_flight_.emplace_back(address, std::move(message));
  }
  /// The messages of an operation from several ranks, in their order.
  std::vector<Message> wait_for(int rank, const std::vector<int>& from, std::int64_t operation) {
    std::unique_lock lock(mutex_);
    Inbox& own = inboxes_[static_cast<std::size_t>(rank)];
    own.operation = operation;
    for (const int sender : from)
      if (!own.arrived.contains({operation, sender})) own.missing.insert(sender);
    while (!own.missing.empty() && !failed_) {
      if (!in_flight_.empty()) {
        deliver_one();
        continue;
      }
      own.sleeps = true;
      wake(lock);
      own.wake.wait();
      lock.lock();
    }
    std::vector<Message> messages;
    const bool lost = !own.missing.empty();
    own.missing.clear();
    for (const int sender : from)
      if (!lost) messages.push_back(std::move(own.arrived.extract({operation, sender}).mapped()));
    wake(lock);
    if (lost) throw RanksLost();
    return messages;
  }
  /// A rank has come to its end: what it sent arrives.
  void leave() {
    std::unique_lock lock(mutex_);
    while (!in_flight_.empty()) deliver_one();
    wake(lock);
  }
  void fail() {
    std::unique_lock lock(mutex_);
    failed_ = true;
    for (Inbox& inbox : inboxes_) note_wake(inbox);
    wake(lock);
  }

 private:
  /// One thread waits until another has given; without spinning, which takes time from the others.
  class Wake {
   public:
    void give() {
      {
        const std::lock_guard lock(mutex_);
        given_ = true;
      }
      told_.notify_one();
    }
    void wait() {
      std::unique_lock lock(mutex_);
      told_.wait(lock, [&] { return given_; });
      given_ = false;
    }

   private:
    std::mutex mutex_;
    std::condition_variable told_;
    bool given_ = false;
  };
  struct Inbox {
    std::map<std::pair<std::int64_t, int>, Message> arrived;  ///< by operation and sender
    std::int64_t operation = 0;                               ///< that is waited for
    std::set<int> missing;                                    ///< senders of that operation
    bool sleeps = false;
    Wake wake;
  };

  void deliver_one() {
    random_ += 0x9e3779b97f4a7c15ULL;
    const std::size_t i = mixed(random_) % in_flight_.size();
    const Address address = in_flight_[i].first;
    Inbox& to = inboxes_[static_cast<std::size_t>(address.to)];
    to.arrived.emplace(std::pair(address.operation, address.from), std::move(in_flight_[i].second));
    if (i + 1 < in_flight_.size()) in_flight_[i] = std::move(in_flight_.back());
    in_flight_.pop_back();
    if (address.operation == to.operation && to.missing.erase(address.from) > 0 &&
        to.missing.empty())
      note_wake(to);
  }
  void note_wake(Inbox& inbox) {
    if (!inbox.sleeps) return;
    inbox.sleeps = false;
    to_wake_.push_back(&inbox);
  }
  /// Gives the lock back and wakes who was noted: none of them has to wait for the lock then.
  void wake(std::unique_lock<std::mutex>& lock) {
    const std::vector<Inbox*> noted = std::exchange(to_wake_, {});
    lock.unlock();
    for (Inbox* const inbox : noted) inbox->wake.give();
  }

  std::mutex mutex_;
  std::vector<Inbox> inboxes_;  ///< of each rank
  std::vector<std::pair<Address, Message>> in_flight_;
  std::vector<Inbox*> to_wake_;
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
    std::vector<int> all(static_cast<std::size_t>(size_));
    std::iota(all.begin(), all.end(), 0);
    return carrier_.wait_for(rank_, all, operation_);
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
      std::vector<int> senders;
      for (const Post& post : from_) senders.push_back(post.rank);
      const auto messages = self_.carrier_.wait_for(self_.rank_, senders, operation_);
      for (std::size_t k = 0; k < from_.size(); ++k) {
        const Post& post = from_[k];
        const Message& message = messages[k];
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
