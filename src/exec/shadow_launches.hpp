#pragma once
// Launches of a device, carried out by the processor in the order that is hardest on them.

#include <functional>

namespace breccia {

/// While one lives, launches in Space::shadow do on this thread what a device may do: a launch
/// reads ahead before the launch before it has done its work. A kernel that reads ahead an array
/// which that launch writes ends with other bits than on the host.
class ShadowLaunches {
 public:
  ShadowLaunches();
  ShadowLaunches(const ShadowLaunches&) = delete;
  ShadowLaunches& operator=(const ShadowLaunches&) = delete;
  /// Does the work of the last launch.
  ~ShadowLaunches();

  /// Whether one lives on this thread.
  static bool open();
  /// Reads ahead now; does the work when the next launch has read ahead, or now if none lives.
  static void add(const std::function<void()>& read_ahead, std::function<void()> work);
};

}  // namespace breccia
