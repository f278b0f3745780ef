#pragma once
// Ranges of a run for profilers (NVTX), and the time of each launch for benchmarks.

#include <map>
#include <string>

namespace breccia {

/// A named range of host time in a profiler's view of the run. Nothing in a build without CUDA.
class ProfileRange {
 public:
  explicit ProfileRange(const char* name);
  ProfileRange(const ProfileRange&) = delete;
  ProfileRange& operator=(const ProfileRange&) = delete;
  ~ProfileRange();
};

/// While one lives, every launch on the GPU is timed by itself and stands in a range of its own:
/// launches do not overlap then, and steps are launched instead of replayed.
class LaunchTimes {
 public:
  struct Entry {
    double seconds = 0.0;
    long launches = 0;
  };

  LaunchTimes();
  LaunchTimes(const LaunchTimes&) = delete;
  LaunchTimes& operator=(const LaunchTimes&) = delete;
  ~LaunchTimes();

  /// Waits for the GPU. @returns what was launched since the last call, by name of the kernel
  std::map<std::string, Entry> take();
  /// Whether one lives.
  static bool wanted();
};

/// The launch in between is timed if LaunchTimes wants it.
class TimedLaunch {
 public:
  explicit TimedLaunch(const std::string& name);
  TimedLaunch(const TimedLaunch&) = delete;
  TimedLaunch& operator=(const TimedLaunch&) = delete;
  ~TimedLaunch();

 private:
  ProfileRange range_;
};

}  // namespace breccia
