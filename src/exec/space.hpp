#pragma once
// Where arrays live and loops run.

#include "exec/types.hpp"

namespace breccia {

class StageTimers;

/// host: the processor's memory. shadow: also the processor's, but only kernels may read it, as if
/// it were a device's (finds forgotten copies without a GPU, in checked builds), and steps are
/// those of a device, launch by launch. cuda: device memory.
enum class Space { host, shadow, cuda };

/// Threads of a block on a device: registers leave room for several blocks of the largest kernels.
inline constexpr Index block_size = 128;

/// Precision of stored numbers. full: double. mixed: states and forces of links, and forces of
/// joints and couples, in single, all others in double; laws and sums compute in double. single:
/// stored likewise, and laws of cohesive links, whole joints and triangles compute in single
/// (docs/theory.md, section 11; docs/theory-fdem.md, section 8).
enum class Precision { full, mixed, single };

/// How a run executes: the space of its arrays and the threads of its host loops.
struct Exec {
  Space space = Space::host;
  int threads = 1;                ///< host threads, >= 1
  StageTimers* timers = nullptr;  ///< where stages book their wall time; may be absent
  Precision precision = Precision::full;
  Index tiles = 0;  ///< most tiles that steps of a device are taken by (dem/tiles); 0: by launches
};

/// True on a thread that is inside a kernel: the only place where shadow arrays may be read.
inline bool& inside_kernel() {
  static thread_local bool inside = false;
  return inside;
}

/// Runs on the host as the calling thread would inside a kernel of its own.
class KernelScope {
 public:
  KernelScope() : outer_(inside_kernel()) { inside_kernel() = true; }
  KernelScope(const KernelScope&) = delete;
  KernelScope& operator=(const KernelScope&) = delete;
  ~KernelScope() { inside_kernel() = outer_; }

 private:
  bool outer_;
};

}  // namespace breccia
