#pragma once
// The two loops of the program: for_each runs a kernel over indices, fold combines a value per
// index.
//
// A kernel is a named struct of views with `operator()(Index) const`, host and device from one
// text. It writes only what it owns, so any number of threads gives the same bits.

#include <algorithm>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "exec/buffer.hpp"
#include "exec/space.hpp"
#if defined(__CUDACC__)
#include "exec/cuda.hpp"
#include "exec/launch_times.hpp"
#endif

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

#if defined(__CUDACC__)
/// The first words of a kernel that launch() starts: it may be on the device before the launch
/// before has ended, whose work it sees from here on. The one after it may come, too.
__device__ inline void follow_previous() {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
  cudaGridDependencySynchronize();
  cudaTriggerProgrammaticLaunchCompletion();
#endif
}

/// What profilers call a kernel: its own name, or that of the one it wraps.
template <class Kernel>
std::string name_of(const Kernel& kernel) {
  if constexpr (requires { Kernel::name; })
    return Kernel::name;
  else if constexpr (requires { kernel.kernel; })
    return name_of(kernel.kernel);
  else
    return "a loop";
}

/// Launches a kernel that begins with follow_previous(). `named` is what it runs.
template <class Named, class... Parameters>
void launch(const Named& named, void (*kernel)(Parameters...), Index blocks, Index threads,
            const std::type_identity_t<Parameters>&... arguments) {
  std::optional<TimedLaunch> timed;
  if (LaunchTimes::wanted()) timed.emplace(name_of(named));
  cudaLaunchAttribute early{};
  early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  early.val.programmaticStreamSerializationAllowed = 1;
  cudaLaunchConfig_t how{};
  how.gridDim = dim3(static_cast<unsigned>(blocks));
  how.blockDim = dim3(static_cast<unsigned>(threads));
  how.stream = device_stream();
  how.attrs = &early;
  how.numAttrs = launches_overlap() && !timed ? 1 : 0;
  check_device(cudaLaunchKernelEx(&how, kernel, arguments...), "a launch");
}

/// A kernel that reads ahead: prepare(i, ready) what the launch before does not write, while that
/// still runs; then it is called with what it has read.
template <class Kernel>
concept ReadsAhead = requires {
  typename Kernel::Ready;
};

/// Item i of a kernel, or nothing if there is none, once the launch before has ended.
template <class Kernel, class Result>
__device__ Result run_item(const Kernel& kernel, Index i, Index count, Result result) {
  if constexpr (ReadsAhead<Kernel>) {
    typename Kernel::Ready ready;
    if (i < count) kernel.prepare(i, ready);
    follow_previous();
    if (i >= count) return result;
    if constexpr (std::is_void_v<decltype(kernel(i, ready))>)
      kernel(i, ready);
    else
      result = kernel(i, ready);
  } else {
    follow_previous();
    if (i >= count) return result;
    if constexpr (std::is_void_v<decltype(kernel(i))>)
      kernel(i);
    else
      result = kernel(i);
  }
  return result;
}

template <class Kernel>
__global__ void __launch_bounds__(block_size) launch_kernel(Index count, Kernel kernel) {
  run_item(kernel, static_cast<Index>(blockIdx.x * blockDim.x + threadIdx.x), count, 0);
}

/// Blocks that must fit a multiprocessor at once, a bound on the registers of a thread: what a
/// kernel says, or what the one says that it wraps; 0: no bound.
template <class Kernel>
constexpr int least_blocks_of() {
  if constexpr (requires { Kernel::least_blocks; })
    return Kernel::least_blocks;
  else if constexpr (requires(Kernel k) { k.kernel; })
    return least_blocks_of<decltype(Kernel::kernel)>();
  else
    return 0;
}

/// Kernels side by side in one launch: each has blocks of its own.
template <class... Kernels>
struct Parts;
template <>
struct Parts<> {
  static constexpr int least_blocks = 0;
  Index blocks() const { return 0; }
  __device__ void run(Index) const {}
};
template <class First, class... Rest>
struct Parts<First, Rest...> {
  Index count;
  First kernel;
  Parts<Rest...> rest;
  static constexpr int least_blocks =
      std::max(least_blocks_of<First>(), Parts<Rest...>::least_blocks);

  __host__ __device__ Index own_blocks() const { return (count + block_size - 1) / block_size; }
  Index blocks() const { return own_blocks() + rest.blocks(); }
  __device__ void run(Index block) const {
    if (block >= own_blocks()) return rest.run(block - own_blocks());
    run_item(kernel, block * block_size + static_cast<Index>(threadIdx.x), count, 0);
  }
};
/// Those of its parts that have items.
inline std::string name_of(const Parts<>&) {
  return "";
}
template <class First, class... Rest>
std::string name_of(const Parts<First, Rest...>& parts) {
  const std::string rest = name_of(parts.rest);
  if (parts.count <= 0) return rest;
  return name_of(parts.kernel) + (rest.empty() ? "" : " + ") + rest;
}
template <class All>
__global__ void __launch_bounds__(block_size, All::least_blocks)
    launch_parts(const __grid_constant__ All all) {
  all.run(static_cast<Index>(blockIdx.x));
}

/// The least of a number over the threads of a block, for its thread 0. The number is not negative.
template <int threads>
__device__ double least_of_block(double number) {
  __shared__ double of_warp[threads / 32];
  for (int half = 16; half > 0; half /= 2)
    number = fmin(number, __shfl_down_sync(~0U, number, half));
  if (threadIdx.x % 32 == 0) of_warp[threadIdx.x / 32] = number;
  __syncthreads();
  for (int warp = 1; warp < threads / 32; ++warp) number = fmin(number, of_warp[warp]);
  return number;
}

/// A kernel that returns a number; the least of each block is noted.
template <int threads, class Kernel, class Note>
__global__ void __launch_bounds__(threads) launch_and_note(Index count, Kernel kernel, Note note) {
  const auto i = static_cast<Index>(blockIdx.x * blockDim.x + threadIdx.x);
  const double least = least_of_block<threads>(run_item(kernel, i, count, Note::neutral));
  if (threadIdx.x == 0) note(least);
}

/// One value a block: each thread folds every n-th item, then the block its threads.
template <class Value, class Kernel, class Combine>
__global__ void __launch_bounds__(block_size)
    fold_blocks(Index count, Value neutral, Kernel kernel, Combine combine, Value* partial) {
  follow_previous();
  __shared__ alignas(16) unsigned char memory[block_size * sizeof(Value)];
  auto* shared = reinterpret_cast<Value*>(memory);
  Value value = neutral;
  for (std::int64_t i = blockIdx.x * std::int64_t{block_size} + threadIdx.x; i < count;
       i += gridDim.x * std::int64_t{block_size})
    value = combine(value, kernel(static_cast<Index>(i)));
  shared[threadIdx.x] = value;
  for (unsigned half = block_size / 2; half > 0; half /= 2) {
    __syncthreads();
    if (threadIdx.x < half)
      shared[threadIdx.x] = combine(shared[threadIdx.x], shared[threadIdx.x + half]);
  }
  if (threadIdx.x == 0) partial[blockIdx.x] = shared[0];
}
#endif

// In a CUDA build the same text makes two kinds of loops: one that can launch, in files that nvcc
// compiles, and one for the host alone in all others. They must not pass for one another.
#if defined(BR_CUDA) && !defined(__CUDACC__)
inline namespace host_loops {
#else
inline namespace loops {
#endif

/// kernel(i) for every i in [0, count), in any order, static schedule.
template <class Kernel>
void for_each(const Exec& exec, Index count, const Kernel& kernel) {
  if (count <= 0) return;
#if defined(__CUDACC__)
  if (exec.space == Space::cuda) {
    launch(kernel, launch_kernel<Kernel>, (count + block_size - 1) / block_size, block_size, count,
           kernel);
    return;
  }
#endif
  BR_ASSERT(exec.space != Space::cuda);
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

#if defined(__CUDACC__)
/// Several loops in one launch on a device: `parts` is made with `part(count, kernel, rest)`.
template <class... Kernels>
void for_each_part(const Parts<Kernels...>& parts) {
  const Index blocks = parts.blocks();
  if (blocks > 0) launch(parts, launch_parts<Parts<Kernels...>>, blocks, block_size, parts);
}
template <class First, class... Rest>
Parts<First, Rest...> part(Index count, const First& kernel, const Parts<Rest...>& rest) {
  return {count, kernel, rest};
}

/// kernel(i) for every i in [0, count), and note() of the least that they return, on a device.
template <class Kernel, class Note>
void for_each_noting(Index count, const Kernel& kernel, const Note& note) {
  constexpr int threads = 128;
  launch(kernel, launch_and_note<threads, Kernel, Note>, (count + threads - 1) / threads, threads,
         count, kernel, note);
}
#endif

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

/// neutral, kernel(0), kernel(1), ... combined into one value, on the host in fixed chunks of
/// `fold_chunk`. The combination must not depend on order (least, largest, sums of whole numbers,
/// ExactSum), so that threads and devices all give the same bits.
template <class Value, class Kernel, class Combine>
Value fold(const Exec& exec, Index count, Value neutral, const Kernel& kernel,
           const Combine& combine) {
  struct Partial {  // by itself in memory: std::vector<bool> would share words among threads
    Value value;
  };
#if defined(__CUDACC__)
  if (exec.space == Space::cuda) {
    if (count <= 0) return neutral;
    const Index blocks = std::min((count + block_size - 1) / block_size, Index{528});
    Buffer<std::byte> partial(Space::cuda, static_cast<Index>(sizeof(Value)) * blocks);
    launch(kernel, fold_blocks<Value, Kernel, Combine>, blocks, block_size, count, neutral, kernel,
           combine, reinterpret_cast<Value*>(partial.data()));
    std::vector<Partial> of_block(static_cast<std::size_t>(blocks), Partial{neutral});
    copy_bytes(of_block.data(), Space::host, partial.data(), Space::cuda,
               of_block.size() * sizeof(Value));
    Value value = neutral;
    for (const Partial& part : of_block) value = combine(value, part.value);
    return value;
  }
#endif
  BR_ASSERT(exec.space != Space::cuda);
  const Index chunks = (count + fold_chunk - 1) / fold_chunk;
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

}  // namespace loops
}  // namespace breccia
