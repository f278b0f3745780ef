#include "domain/watchdog.hpp"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

namespace breccia {

Watchdog::Watchdog(std::span<LifeSign> signs, std::size_t self,
                   std::function<void(std::size_t)> lost)
    : signs_(signs), self_(self), lost_(std::move(lost)) {
  // Signals are for the thread that runs the program.
  sigset_t all, former;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &former);
  thread_ = std::thread([this] { watch(); });
  ::pthread_sigmask(SIG_SETMASK, &former, nullptr);
}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  thread_.join();
  signs_[self_].ended = 1;
}

void Watchdog::lose(std::unique_lock<std::mutex>& lock, std::size_t rank) {
  lock.unlock();
  lost_(rank);
}

void Watchdog::watch() {
  std::vector<std::uint32_t> seen(signs_.size(), 0);
  std::vector<double> silent(signs_.size(), 0.0);  // time without a new sign  [s]
  std::uint64_t message = 0;
  double waited = 0.0;  // for the same answer  [s]
  std::unique_lock lock(mutex_);
  while (!end_) {
    const double patience = patience_;
    const double round = patience > 0.0 ? std::clamp(patience / 16.0, 0.001, 0.05) : 0.05;
    changed_.wait_for(lock, std::chrono::duration<double>(round));
    ++signs_[self_].beat;
    const std::uint64_t now = signs_[self_].message.load(std::memory_order_relaxed);
    waited = now == message && now % 2 == 1 ? waited + round : 0.0;
    message = now;
    std::size_t late = signs_.size();  // the rank that is the furthest behind
    std::uint64_t done = now;
    for (std::size_t r = 0; r < signs_.size(); ++r) {
      if (const std::uint64_t its = signs_[r].message; its < done) {
        done = its;
        late = r;
      }
      const std::uint32_t beat = signs_[r].beat;
      silent[r] = beat == seen[r] && signs_[r].ended == 0 ? silent[r] + round : 0.0;
      seen[r] = beat;
      if (patience > 0.0 && silent[r] >= patience) return lose(lock, r);
    }
    if (patience > 0.0 && waited >= slow * patience) return lose(lock, late);
  }
}

}  // namespace breccia
