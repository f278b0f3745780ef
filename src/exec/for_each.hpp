#pragma once
// The two loops of the program: for_each runs a kernel over indices, fold combines a value per
// index.
//
// A kernel is a named struct of views with `operator()(Index) const`, host and device from one
// text. It writes only what it owns, so any number of threads gives the same bits.

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include "exec/buffer.hpp"
#include "exec/launch.hpp"
#include "exec/space.hpp"

namespace breccia {

/// Below this many items a loop is not worth waking other threads for.
inline constexpr Index smallest_shared_loop = 512;

/// The items a fold combines into one partial result: fixed, so that sums do not depend on threads.
inline constexpr Index fold_chunk = 1024;

/// Combinations for fold.
struct Least {
  template <class T>
  BR_HD T operator()(const T& a, const T& b) const {
    return b < a ? b : a;
  }
};
struct Largest {
  template <class T>
  BR_HD T operator()(const T& a, const T& b) const {
    return a < b ? b : a;
  }
};
struct Sum {
  template <class T>
  BR_HD T operator()(const T& a, const T& b) const {
    return a + b;
  }
};

// In a CUDA build the same text makes two kinds of loops: one that can launch, in files that nvcc
// compiles, and one for the host alone in all others. They must not pass for one another.
#if defined(BR_CUDA) && !defined(__CUDACC__)
inline namespace host_loops {
#else
inline namespace loops {
#endif

/// Whether a kernel loops over arrays of the host in every build: a run of the host says so.
template <class Kernel>
inline constexpr bool on_host_alone = false;

#if defined(BR_CUDA) && !defined(__CUDACC__)
// Templates around this loop have one name in all files, so the linker may take the text that
// cannot launch for the one that can.
#define BR_REFUSE_LOOP(Kernel) \
  static_assert(on_host_alone<Kernel>, "nvcc must compile this file: CMakeLists.txt, br_kernels")
#else
#define BR_REFUSE_LOOP(Kernel) static_assert(true)
#endif

/// kernel(i) for every i in [0, count), in any order, static schedule.
template <class Kernel>
void for_each(const Exec& exec, Index count, const Kernel& kernel) {
  BR_REFUSE_LOOP(Kernel);
  if (count <= 0) return;
#if defined(__CUDACC__)
  if (exec.space == Space::cuda) {
    launch(kernel, launch_kernel<Kernel>, (count + block_size - 1) / block_size, block_size, count,
           kernel);
    return;
  }
#endif
  BR_ASSERT(exec.space != Space::cuda);
  if (exec.space == Space::shadow && ShadowLaunches::open())
    return ShadowLaunches::add(nullptr, [count, kernel] {
      const KernelScope scope;
      for (Index i = 0; i < count; ++i) kernel(i);
    });
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

/// Several loops, one after the other or, on a device, side by side in one launch.
template <class... Kernels>
void for_each_of(const Exec& exec, const Parts<Kernels...>& parts) {
  if (exec.space == Space::cuda) return for_each_part(exec, parts);
  parts.each([&](Index count, const auto& kernel) { for_each(exec, count, kernel); });
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

/// One item more of a fold on the host. A kernel of large values may have add_to(value, i) in place
/// of operator()(i): it adds the numbers that an item has, and leaves the value's others alone.
template <class Value, class Kernel, class Combine>
inline void fold_item(Value& value, const Kernel& kernel, Index i, const Combine& combine) {
  if constexpr (requires { kernel.add_to(value, i); })
    kernel.add_to(value, i);
  else
    value = combine(value, kernel(i));
}

/// Items [begin, end): by add_run(value, begin, end), where a kernel has one.
template <class Value, class Kernel, class Combine>
inline void fold_items(Value& value, const Kernel& kernel, Index begin, Index end,
                       const Combine& combine) {
  if constexpr (requires { kernel.add_run(value, begin, end); })
    kernel.add_run(value, begin, end);
  else
    for (Index i = begin; i < end; ++i) fold_item(value, kernel, i, combine);
}

/// A value that a launch finds while the host goes on; on a host it is there already.
template <class Value>
class Later {
 public:
  explicit Later(const Value& value) : value_(value) {}
#if defined(__CUDACC__)
  Later(const Value& otherwise, const Look& look) : value_(otherwise), look_(look) {}
#endif
  /// Waits for it. Of a stream at most `looks_on_their_way` values may be waited for at a time.
  Value value() const {
#if defined(__CUDACC__)
    if (look_) {
      wait_for(*look_);
      Value value = value_;
      std::memcpy(static_cast<void*>(&value), look_->told, sizeof value);
      return value;
    }
#endif
    return value_;
  }

 private:
  Value value_;
#if defined(__CUDACC__)
  std::optional<Look> look_;
#endif
};

/// neutral, kernel(0), kernel(1), ... combined into one value, on the host in fixed chunks of
/// `fold_chunk`. The combination must not depend on order (least, largest, sums of whole numbers,
/// ExactSum), so that threads and devices all give the same bits.
template <class Value, class Kernel, class Combine>
Later<Value> fold_later(const Exec& exec, Index count, Value neutral, const Kernel& kernel,
                        const Combine& combine) {
  BR_REFUSE_LOOP(Kernel);
  struct Partial {  // by itself in memory: std::vector<bool> would share words among threads
    Value value;
  };
#if defined(__CUDACC__)
  if (exec.space == Space::cuda) {
    if (count <= 0) return Later<Value>(neutral);
    const Index blocks = std::min((count + block_size - 1) / block_size, Index{528});
    const Look look = next_look(static_cast<std::size_t>(blocks) * sizeof(Value));
    launch(kernel, fold_and_tell<Value, Kernel, Combine>, blocks, block_size, count, neutral,
           kernel, combine, look);
    return {neutral, look};
  }
#endif
  BR_ASSERT(exec.space != Space::cuda);
  const Index chunks = (count + fold_chunk - 1) / fold_chunk;
  std::vector<Partial> partial(static_cast<std::size_t>(chunks), Partial{neutral});
  const auto fold_one = [&](Index chunk) {
    const KernelScope scope;
    Value value = neutral;
    const Index end = std::min(count, (chunk + 1) * fold_chunk);
    fold_items(value, kernel, chunk * fold_chunk, end, combine);
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
  return Later<Value>(value);
}
template <class Value, class Kernel, class Combine>
Value fold(const Exec& exec, Index count, Value neutral, const Kernel& kernel,
           const Combine& combine) {
  return fold_later(exec, count, neutral, kernel, combine).value();
}

}  // namespace loops
}  // namespace breccia
