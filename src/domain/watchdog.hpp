#pragma once
// Notices ranks that no longer answer: a process that was stopped, a thread that waits for ever.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <thread>

namespace breccia {

/// Signs of life of a rank, in memory that the ranks of a machine share. All zero at first.
struct alignas(64) LifeSign {
  std::atomic<std::uint32_t> beat;     ///< goes on as long as the process runs
  std::atomic<std::uint32_t> ended;    ///< 1: nobody need watch it any more
  std::atomic<std::uint64_t> message;  ///< operations begun and done: odd while it waits for others
  std::atomic<std::uint32_t> told;     ///< of the first rank: 1 when someone has told of a loss
};

/// A thread that shows that this process runs, and looks whether the others do. It counts its own
/// rounds, not time, so that a job that was stopped as a whole goes on unharmed.
class Watchdog {
 public:
  /// Two ways to be lost: the process of a rank on this machine shows no sign for `patience`, or
  /// this rank has waited `slow` times as long for an answer (others may write a large file
  /// meanwhile).
  static constexpr int slow = 10;

  /// @param signs  of all ranks on this machine; they outlive the watchdog
  /// @param self   which of them is this rank's
  /// @param lost   called once, on the watchdog's thread, with the place of the lost rank in
  ///               `signs`, or their number if it must be on another machine
  Watchdog(std::span<LifeSign> signs, std::size_t self, std::function<void(std::size_t)> lost);
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  /// The others no longer expect signs of this rank.
  ~Watchdog();

  /// How long ranks may be silent; 0: for ever.  [s]
  void set_patience(double seconds) { patience_ = seconds; }
  double patience() const { return patience_; }

  /// Around what this rank asks of the others.
  void begin_waiting() { step_message(); }
  void end_waiting() { step_message(); }

 private:
  void step_message() { signs_[self_].message.fetch_add(1, std::memory_order_relaxed); }
  void watch();
  void lose(std::unique_lock<std::mutex>& lock, std::size_t rank);

  std::span<LifeSign> signs_;
  std::size_t self_;
  std::function<void(std::size_t)> lost_;
  std::atomic<double> patience_ = 0.0;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool end_ = false;
  std::thread thread_;
};

}  // namespace breccia
