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
#if defined(__CUDACC__)
#include "exec/cuda.hpp"
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

/// A kernel over part of its arrays: item i of the loop is item first + i of the kernel.
template <class Kernel>
struct Shifted {
  Kernel kernel;
  Index first;
  BR_HD void operator()(Index i) const { kernel(first + i); }
  template <class Times>
  BR_HD void set(const Times& now) {
    kernel.set(now);
  }
};

#if defined(__CUDACC__)
template <class Kernel>
__global__ void __launch_bounds__(block_size) launch_kernel(Index count, Kernel kernel) {
  const auto i = static_cast<Index>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < count) kernel(i);
}

/// Kernels side by side in one launch: each has blocks of its own.
template <class... Kernels>
struct Parts;
template <>
struct Parts<> {
  Index blocks() const { return 0; }
  __device__ void run(Index) const {}
};
template <class First, class... Rest>
struct Parts<First, Rest...> {
  Index count;
  First kernel;
  Parts<Rest...> rest;

  __host__ __device__ Index own_blocks() const { return (count + block_size - 1) / block_size; }
  Index blocks() const { return own_blocks() + rest.blocks(); }
  __device__ void run(Index block) const {
    if (block >= own_blocks()) return rest.run(block - own_blocks());
    const Index i = block * block_size + static_cast<Index>(threadIdx.x);
    if (i < count) kernel(i);
  }
};
template <class All>
__global__ void __launch_bounds__(block_size) launch_parts(All all) {
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

/// A kernel that returns a number, of which the least is noted; the last block of all finishes.
template <int threads, class Kernel, class Last>
__global__ void __launch_bounds__(threads)
    launch_and_finish(Index count, Kernel kernel, unsigned* blocks_done, Last last) {
  const auto i = static_cast<Index>(blockIdx.x * blockDim.x + threadIdx.x);
  const double own = i < count ? kernel(i) : Last::neutral;
  const double least = least_of_block<threads>(own);
  if (threadIdx.x != 0) return;
  last.note(least);
  __threadfence();
  if (atomicAdd(blocks_done, 1U) != gridDim.x - 1) return;
  *blocks_done = 0;
  __threadfence();
  last(0);
}

/// One value a block: each thread folds every n-th item, then the block its threads.
template <class Value, class Kernel, class Combine>
__global__ void __launch_bounds__(block_size)
    fold_blocks(Index count, Value neutral, Kernel kernel, Combine combine, Value* partial) {
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
    const auto blocks = static_cast<unsigned>((count + block_size - 1) / block_size);
    launch_kernel<<<blocks, block_size, 0, device_stream()>>>(count, kernel);
    check_device(cudaGetLastError(), "a launch");
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
  if (blocks == 0) return;
  launch_parts<<<static_cast<unsigned>(blocks), block_size, 0, device_stream()>>>(parts);
  check_device(cudaGetLastError(), "a launch");
}
template <class First, class... Rest>
Parts<First, Rest...> part(Index count, const First& kernel, const Parts<Rest...>& rest) {
  return {count, kernel, rest};
}

/// kernel(i) for every i in [0, count), last.note() of the least that they return, then last(0), on
/// a device.
/// @param blocks_done  zero before and after
template <class Kernel, class Last>
void for_each_then(Index count, const Kernel& kernel, Buffer<unsigned>& blocks_done,
                   const Last& last) {
  constexpr int threads = 256;
  const auto blocks = static_cast<unsigned>((count + threads - 1) / threads);
  launch_and_finish<threads>
      <<<blocks, threads, 0, device_stream()>>>(count, kernel, blocks_done.data(), last);
  check_device(cudaGetLastError(), "a launch");
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
    fold_blocks<<<static_cast<unsigned>(blocks), block_size, 0, device_stream()>>>(
        count, neutral, kernel, combine, reinterpret_cast<Value*>(partial.data()));
    check_device(cudaGetLastError(), "a launch");
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
