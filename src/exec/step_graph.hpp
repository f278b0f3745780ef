#pragma once
// Launches that a GPU repeats: recorded once as a CUDA graph, replayed with one call.

#include <memory>
#include <vector>

#include "exec/shadow_launches.hpp"
#include "exec/space.hpp"

namespace breccia {

/// A recorded sequence of launches on the run's stream. In Space::shadow the processor keeps the
/// kernels with the arrays they were made with, and carries them out again: a graph that outlives
/// its arrays shows there, too.
class StepGraph {
 public:
  StepGraph();
  StepGraph(StepGraph&&) noexcept;
  StepGraph& operator=(StepGraph&&) noexcept;
  /// A copy has nothing recorded: the arrays of what it belongs to are others.
  StepGraph(const StepGraph& other);
  StepGraph& operator=(const StepGraph& other);
  ~StepGraph();

  /// Records what `launch()` launches in a space, instead of running it. It must not take memory,
  /// copy or wait.
  template <class Launch>
  void record(Space space, const Launch& launch) {
    if (space == Space::shadow) {
      const ShadowLaunches::Recording recording(emptied());
      launch();
      stale_ = false;
      return;
    }
    begin();
    try {
      launch();
    } catch (...) {
      give_up();  // else the stream would go on recording, for the next run of this process, too
      throw;
    }
    end();
  }
  bool empty() const;
  /// Forgets the launches: after their arrays have moved.
  void clear();
  /// Runs the recorded launches once. @throws DeviceError
  void replay() const;

  double pace = 0.0;  ///< how long a step took when that was last seen; 0: not yet  [s]

 private:
  struct Recorded;
  void begin();
  void end();
  void give_up() noexcept;
  Recorded& recorded();
  bool replayed_in_shadow() const;
  /// Where the launches of a new recording go in Space::shadow.
  std::vector<ShadowLaunches::Launch>& emptied();
  std::unique_ptr<Recorded> recorded_;
  bool stale_ = true;
};

}  // namespace breccia
