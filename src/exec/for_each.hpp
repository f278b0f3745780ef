#pragma once
// The two loops of the program: for_each runs a kernel over indices, fold combines a value per
// index.
//
// A kernel is a named struct of views with `operator()(Index) const`, host and device from one
// text. It writes only what it owns, so any number of threads gives the same bits.

#include <algorithm>
#include <vector>

#include "exec/buffer.hpp"
#include "exec/space.hpp"

namespace breccia {

/// Below this many items a loop is not worth waking other threads for.
inline constexpr Index smallest_shared_loop = 512;

/// The items a fold combines into one partial result: fixed, so that sums do not depend on threads.
inline constexpr Index fold_chunk = 1024;

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

#if defined(__CUDACC__)
template <class Kernel>
__global__ void launch_kernel(Index count, Kernel kernel) {
  const Index i = static_cast<Index>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < count) kernel(i);
}
#endif

/// A kernel over part of its arrays: item i of the loop is item first + i of the kernel.
template <class Kernel>
struct Shifted {
  Kernel kernel;
  Index first;
  BR_HD void operator()(Index i) const { kernel(first + i); }
};

/// kernel(i) for every i in [0, count), in any order, static schedule.
template <class Kernel>
void for_each(const Exec& exec, Index count, const Kernel& kernel) {
  if (count <= 0) return;
#if defined(__CUDACC__)
  if (exec.space == Space::cuda) {
    constexpr Index block = 128;
    launch_kernel<<<(count + block - 1) / block, block>>>(count, kernel);
    return;
  }
#endif
  if (exec.threads <= 1 || count < smallest_shared_loop) {
    const KernelScope scope;
    for (Index i = 0; i < count; ++i) kernel(i);
    return;
  }
#pragma omp parallel num_threads(exec.threads)
  {
    const KernelScope scope;
#pragma omp for schedule(static)
    for (Index i = 0; i < count; ++i) kernel(i);
  }
}

/// run(begin, end) for runs of `grain` items that make up [0, count), on the host: for kernels that
/// take several items at once.
template <class Run>
void for_each_run(const Exec& exec, Index count, Index grain, const Run& run) {
  const Index runs = (count + grain - 1) / grain;
  const auto one = [&](Index r) {
    const KernelScope scope;
    run(r * grain, std::min(count, (r + 1) * grain));
  };
  if (exec.threads <= 1 || runs < 2) {
    for (Index r = 0; r < runs; ++r) one(r);
    return;
  }
#pragma omp parallel for schedule(static) num_threads(exec.threads)
  for (Index r = 0; r < runs; ++r) one(r);
}

/// combine(...combine(combine(neutral, kernel(0)), kernel(1))...), in fixed chunks of `fold_chunk`
/// whose partial results are combined in ascending order: the same bits for any thread count.
template <class Value, class Kernel, class Combine>
Value fold(const Exec& exec, Index count, Value neutral, const Kernel& kernel,
           const Combine& combine) {
  const Index chunks = (count + fold_chunk - 1) / fold_chunk;
  struct Partial {  // by itself in memory: std::vector<bool> would share words among threads
    Value value;
  };
  std::vector<Partial> partial(static_cast<std::size_t>(chunks), Partial{neutral});
  const auto fold_one = [&](Index chunk) {
    const KernelScope scope;
    Value value = neutral;
    const Index end = std::min(count, (chunk + 1) * fold_chunk);
    for (Index i = chunk * fold_chunk; i < end; ++i) value = combine(value, kernel(i));
    partial[static_cast<std::size_t>(chunk)].value = value;
  };
  if (exec.threads <= 1 || chunks < 2) {
    for (Index chunk = 0; chunk < chunks; ++chunk) fold_one(chunk);
  } else {
#pragma omp parallel for schedule(static) num_threads(exec.threads)
    for (Index chunk = 0; chunk < chunks; ++chunk) fold_one(chunk);
  }
  Value value = neutral;
  for (const Partial& part : partial) value = combine(value, part.value);
  return value;
}

}  // namespace breccia
