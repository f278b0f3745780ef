#pragma once
// Launches that a GPU repeats: recorded once as a CUDA graph, replayed with one call.

#include <memory>

namespace breccia {

/// A recorded sequence of launches on the run's stream. Empty on the host.
class StepGraph {
 public:
  StepGraph();
  StepGraph(StepGraph&&) noexcept;
  StepGraph& operator=(StepGraph&&) noexcept;
  /// A copy has nothing recorded: the arrays of what it belongs to are others.
  StepGraph(const StepGraph& other);
  StepGraph& operator=(const StepGraph& other);
  ~StepGraph();

  /// Records what `launch()` launches, instead of running it. It must not take memory, copy or
  /// wait.
  template <class Launch>
  void record(const Launch& launch) {
    begin();
    launch();
    end();
  }
  bool empty() const;
  /// Forgets the launches: after their arrays have moved.
  void clear();
  /// Runs the recorded launches once. @throws DeviceError
  void replay() const;

 private:
  struct Recorded;
  void begin();
  void end();
  std::unique_ptr<Recorded> recorded_;
  bool stale_ = true;
};

}  // namespace breccia
