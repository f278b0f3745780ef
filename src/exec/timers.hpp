#pragma once
// Wall time by stage.

#include <chrono>
#include <map>
#include <new>
#include <string>

#include "exec/launch_times.hpp"
#include "exec/space.hpp"

namespace breccia {

/// Seconds and calls spent in each named stage of a step.
class StageTimers {
 public:
  struct Entry {
    double seconds = 0.0;
    long calls = 0;
  };
  void add(const char* stage, double seconds) {
    Entry& entry = stages_[stage];
    entry.seconds += seconds;
    ++entry.calls;
  }
  void clear() { stages_.clear(); }
  const std::map<std::string, Entry, std::less<>>& stages() const { return stages_; }

 private:
  std::map<std::string, Entry, std::less<>> stages_;
};

/// Books the time from its construction to its end under one stage name, which profilers see too.
class StageTime {
 public:
  StageTime(const Exec& exec, const char* stage)
      : range_(stage), timers_(exec.timers), stage_(stage) {
    if (timers_ != nullptr) start_ = std::chrono::steady_clock::now();
  }
  StageTime(const StageTime&) = delete;
  StageTime& operator=(const StageTime&) = delete;
  ~StageTime() {
    try {
      if (timers_ == nullptr) return;
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
      timers_->add(stage_, spent.count());
    } catch (const std::bad_alloc&) {  // time that is not booked harms nobody
    }
  }

 private:
  ProfileRange range_;
  StageTimers* timers_;
  const char* stage_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace breccia
