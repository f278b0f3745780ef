#pragma once
// Launches of a device, carried out by the processor in the order that is hardest on them.

#include <functional>
#include <vector>

namespace breccia {

/// While one lives, launches in Space::shadow do on this thread what a device may do: a launch
/// reads ahead before the launch before it has done its work. A kernel that reads ahead an array
/// which that launch writes ends with other bits than on the host.
class ShadowLaunches {
 public:
  /// One launch: its kernels as they were, with the arrays that they were made with.
  struct Launch {
    std::function<void()> read_ahead, work;
  };

  ShadowLaunches();
  ShadowLaunches(const ShadowLaunches&) = delete;
  ShadowLaunches& operator=(const ShadowLaunches&) = delete;
  /// Does the work of the last launch.
  ~ShadowLaunches();

  /// Whether one lives on this thread.
  static bool open();
  /// Reads ahead now; does the work when the next launch has read ahead, or now if none lives.
  static void add(std::function<void()> read_ahead, std::function<void()> work);

  /// While one lives, launches of this thread are kept, as in a graph of a device, instead of
  /// carried out.
  class Recording {
   public:
    explicit Recording(std::vector<Launch>& to);
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;
    ~Recording();
  };
};

}  // namespace breccia
