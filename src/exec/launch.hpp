#pragma once
// Launches of a device: kernels that read ahead, several kernels side by side, the least of what
// they return. In Space::shadow the processor carries the same launches out.

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "exec/buffer.hpp"
#include "exec/lockstep.hpp"
#include "exec/shadow_launches.hpp"
#include "exec/space.hpp"
#if defined(__CUDACC__)
#include "exec/cuda.hpp"
#include "exec/launch_times.hpp"
#include "exec/look.hpp"
#endif

namespace breccia {

/// Name of a kernel in profilers: its own, or that of the kernel it wraps.
template <class Kernel>
std::string name_of(const Kernel& kernel) {
  if constexpr (requires { Kernel::name; })
    return Kernel::name;
  else if constexpr (requires { kernel.kernel; })
    return name_of(kernel.kernel);
  else
    return "a loop";
}

/// A kernel that reads ahead: load_early(i, loaded) what the launch before does not write, while
/// that still runs; then it is called with what it has read.
template <class Kernel>
concept LoadsAhead = requires {
  typename Kernel::Loaded;
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

/// Item i of a kernel, or nothing if there is none, once the launch before has ended.
template <class Kernel, class Result>
__device__ Result run_item(const Kernel& kernel, Index i, Index count, Result result) {
  if constexpr (LoadsAhead<Kernel>) {
    typename Kernel::Loaded loaded;
    if (i < count) kernel.load_early(i, loaded);
    follow_previous();
    if (i >= count) return result;
    if constexpr (std::is_void_v<decltype(kernel(i, loaded))>)
      kernel(i, loaded);
    else
      result = kernel(i, loaded);
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

#endif

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
  BR_HD void run(Index) const {}
  template <class Visit>
  void each(const Visit&) const {}
};
template <class First, class... Rest>
struct Parts<First, Rest...> {
  Index count;
  First kernel;
  Parts<Rest...> rest;
  static constexpr int least_blocks =
      std::max(least_blocks_of<First>(), Parts<Rest...>::least_blocks);

  BR_HD Index own_blocks() const { return (count + block_size - 1) / block_size; }
  Index blocks() const { return own_blocks() + rest.blocks(); }
#if defined(__CUDACC__)
  __device__ void run(Index block) const {
    if (block >= own_blocks()) return rest.run(block - own_blocks());
    run_item(kernel, block * block_size + static_cast<Index>(threadIdx.x), count, 0);
  }
#endif
  /// Calls visit(count, kernel) for each part.
  template <class Visit>
  void each(const Visit& visit) const {
    visit(count, kernel);
    rest.each(visit);
  }
};
/// Names of the parts that have items.
inline std::string name_of(const Parts<>&) {
  return "";
}
template <class First, class... Rest>
std::string name_of(const Parts<First, Rest...>& parts) {
  const std::string rest = name_of(parts.rest);
  if (parts.count <= 0) return rest;
  return name_of(parts.kernel) + (rest.empty() ? "" : " + ") + rest;
}

#if defined(__CUDACC__)
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

/// One item more of a fold: as fold_item() of the host, in place.
template <class Value, class Kernel, class Combine>
__device__ void add_item(Value& value, const Kernel& kernel, Index i, const Combine& combine) {
  if constexpr (requires { kernel.add_to(value, i); })
    kernel.add_to(value, i);
  else
    value = combine(value, kernel(i));
}

/// Whether values are sums of several kinds, one after the other in memory, that combine one by
/// one: `Value::Part`, `Value::parts` of them.
template <class Value>
concept MadeOfParts = requires {
  typename Value::Part;
  requires sizeof(Value) == Value::parts * sizeof(typename Value::Part);
};

/// Combines parts that lie at all[k * parts] for k < count: a thread takes those of one kind of
/// every n-th value, then a thread each kind. The value comes to lie in `shared`.
template <class Value, class Combine>
__device__ void combine_parts(const typename Value::Part* all, Index count, const Combine& combine,
                              typename Value::Part* shared) {
  using Part = typename Value::Part;
  constexpr Index parts = Value::parts, takers = block_size / parts, stride = takers * parts;
  constexpr int at_once = 4;  // on their way from memory
  const auto thread = static_cast<Index>(threadIdx.x);
  Part own{};
  if (thread < stride) {
    for (Index k = thread; k < count * parts; k += at_once * stride) {
      Part next[at_once];
#pragma unroll
      for (int j = 0; j < at_once; ++j)
        next[j] = k + j * stride < count * parts ? all[k + j * stride] : Part{};
#pragma unroll
      for (int j = 0; j < at_once; ++j) own = combine(own, next[j]);
    }
  }
  __syncthreads();  // all may be shared
  if (thread < stride) shared[thread] = own;
  __syncthreads();
  if (thread < parts)
    for (Index k = 1; k < takers; ++k)
      shared[thread] = combine(shared[thread], shared[k * parts + thread]);
  __syncthreads();
}

/// Combines the values of a block's threads into that of thread 0.
template <class Value, class Combine>
__device__ void combine_block(const Combine& combine, Value* shared) {
  if constexpr (MadeOfParts<Value>) {
    __syncthreads();
    auto* const parts = reinterpret_cast<typename Value::Part*>(shared);
    combine_parts<Value>(parts, block_size, combine, parts);
  } else {
    for (unsigned half = block_size / 2; half > 0; half /= 2) {
      __syncthreads();
      if (threadIdx.x < half)
        shared[threadIdx.x] = combine(shared[threadIdx.x], shared[threadIdx.x + half]);
    }
  }
}

/// The value of a block of a fold, for its thread 0: each thread folds every n-th item, then the
/// block its threads.
template <class Value, class Kernel, class Combine>
__device__ void fold_in_block(std::int64_t first, std::int64_t stride, Index count,
                              const Value& neutral, const Kernel& kernel, const Combine& combine,
                              Value* shared) {
  // Each thread's value lies in `shared` from the start: of a copy of `neutral` in registers nvcc
  // 13.0 forgets in each turn what the turns before have added (bench/notes/tried.md).
  Value& value = shared[threadIdx.x];
  value = neutral;
  for (std::int64_t i = first + threadIdx.x; i < count; i += stride)
    add_item(value, kernel, static_cast<Index>(i), combine);
  combine_block(combine, shared);
}

/// One value a block.
template <class Value, class Kernel, class Combine>
__global__ void __launch_bounds__(block_size)
    fold_blocks(Index count, Value neutral, Kernel kernel, Combine combine, Value* partial) {
  follow_previous();
  __shared__ alignas(16) unsigned char memory[block_size * sizeof(Value)];
  auto* shared = reinterpret_cast<Value*>(memory);
  fold_in_block(blockIdx.x * std::int64_t{block_size}, gridDim.x * std::int64_t{block_size}, count,
                neutral, kernel, combine, shared);
  if (threadIdx.x == 0) partial[blockIdx.x] = shared[0];
}

/// Values that blocks have found.
template <class Value>
struct FoundBefore {
  const Value* found;
  __device__ Value operator()(Index i) const { return found[i]; }
};
/// Combines what blocks have found, by one block, whose thread 0 tells it.
template <class Value, class Combine>
__device__ void tell_all(const Value* found, Index count, const Value& neutral,
                         const Combine& combine, const Look& look, Value* shared) {
  if constexpr (MadeOfParts<Value>)
    combine_parts<Value>(reinterpret_cast<const typename Value::Part*>(found), count, combine,
                         reinterpret_cast<typename Value::Part*>(shared));
  else
    fold_in_block(0, block_size, count, neutral, FoundBefore<Value>{found}, combine, shared);
  if (threadIdx.x == 0) tell(look, shared[0]);
}

/// The value of all blocks, which the last one tells.
template <class Value, class Kernel, class Combine>
__global__ void __launch_bounds__(block_size)
    fold_and_tell(Index count, Value neutral, Kernel kernel, Combine combine, Look look) {
  follow_previous();
  __shared__ alignas(16) unsigned char memory[block_size * sizeof(Value)];
  auto* shared = reinterpret_cast<Value*>(memory);
  auto* partial = reinterpret_cast<Value*>(look.work);
  fold_in_block(blockIdx.x * std::int64_t{block_size}, gridDim.x * std::int64_t{block_size}, count,
                neutral, kernel, combine, shared);
  if (threadIdx.x == 0) partial[blockIdx.x] = shared[0];
  if (!is_last_block(look)) return;
  tell_all(partial, static_cast<Index>(gridDim.x), neutral, combine, look, shared);
}

/// The value of all that launches before have found, by one block.
template <class Value, class Combine>
__global__ void __launch_bounds__(block_size)
    tell_found(const Value* found, Index count, Value neutral, Combine combine, Look look) {
  follow_previous();
  __shared__ alignas(16) unsigned char memory[block_size * sizeof(Value)];
  tell_all(found, count, neutral, combine, look, reinterpret_cast<Value*>(memory));
}
#endif

/// Lanes that work on one item of a kernel together: what a kernel says, or the one that it wraps.
template <class Kernel>
constexpr int lanes_of() {
  if constexpr (requires { Kernel::width; })
    return static_cast<int>(Kernel::width);
  else if constexpr (requires(Kernel k) { k.kernel; })
    return lanes_of<decltype(Kernel::kernel)>();
  else
    return 1;
}
/// Threads that a kernel of `count` threads is launched by: those of whole warps, if several work
/// on an item.
template <class Kernel>
constexpr Index threads_for(Index count) {
  return lanes_of<Kernel>() > 1 ? whole_warps(count) : count;
}

#if defined(BR_CUDA) && !defined(__CUDACC__)
inline namespace host_loops {
#else
inline namespace loops {
#endif

/// A launch of one kernel, carried out by the processor.
/// @tparam Note  called with each number that the kernel returns
template <class Kernel, class Note>
class ShadowLaunch {
 public:
  ShadowLaunch(Index count, const Kernel& kernel, const Note& note)
      : count_(count), kernel_(kernel), note_(note) {}

  void read_ahead() {
    if constexpr (LoadsAhead<Kernel>) {
      const KernelScope scope;
      loaded_.resize(static_cast<std::size_t>(count_));
      for (Index i = 0; i < count_; ++i)
        kernel_.load_early(i, loaded_[static_cast<std::size_t>(i)]);
    }
  }
  void work() {
    const KernelScope scope;
    constexpr bool in_warps = lanes_of<Kernel>() > 1;
    for (first_ = 0; first_ < count_; first_ += in_warps ? lockstep::lanes : 1)
      if constexpr (!in_warps)
        one(first_);
      else
        lockstep::run(
            [](void* self, int lane) {
              auto* const launch = static_cast<ShadowLaunch*>(self);
              launch->one(launch->first_ + lane);
            },
            this);
  }

 private:
  void one(Index i) {
    if constexpr (LoadsAhead<Kernel>)
      finish(i, loaded_[static_cast<std::size_t>(i)]);
    else
      finish(i);
  }
  template <class... Read>
  void finish(Index i, Read&... loaded) {
    if constexpr (std::is_void_v<decltype(kernel_(i, loaded...))>)
      kernel_(i, loaded...);
    else
      note_(kernel_(i, loaded...));
  }

  template <class Of>
  struct LoadedFor {
    using type = char;
  };
  template <LoadsAhead Of>
  struct LoadedFor<Of> {
    using type = typename Of::Loaded;
  };

  Index count_, first_ = 0;
  Kernel kernel_;
  Note note_;
  std::vector<typename LoadedFor<Kernel>::type> loaded_;
};

struct NoteNothing {
  template <class Number>
  void operator()(const Number&) const {}
};

/// kernels as one launch of Space::shadow.
template <class Kernel, class Note>
void launch_in_shadow(Index count, const Kernel& kernel, const Note& note) {
  const auto launch = std::make_shared<ShadowLaunch<Kernel, Note>>(count, kernel, note);
  ShadowLaunches::add([launch] { launch->read_ahead(); }, [launch] { launch->work(); });
}

/// Several loops in one launch on a device: `parts` is made with `part(count, kernel, rest)`.
template <class... Kernels>
void for_each_part([[maybe_unused]] const Exec& exec, const Parts<Kernels...>& parts) {
  const Index blocks = parts.blocks();
  if (blocks <= 0) return;
#if defined(__CUDACC__)
  if (exec.space == Space::cuda)
    return launch(parts, launch_parts<Parts<Kernels...>>, blocks, block_size, parts);
#endif
  BR_ASSERT(exec.space == Space::shadow);
  std::vector<std::function<void()>> ahead, work;
  parts.each([&](Index count, const auto& kernel) {
    using Launch = ShadowLaunch<std::remove_cvref_t<decltype(kernel)>, NoteNothing>;
    const auto launch = std::make_shared<Launch>(count, kernel, NoteNothing{});
    ahead.push_back([launch] { launch->read_ahead(); });
    work.push_back([launch] { launch->work(); });
  });
  const auto all = [](const std::vector<std::function<void()>>& calls) {
    return [calls] {
      for (const auto& call : calls) call();
    };
  };
  ShadowLaunches::add(all(ahead), all(work));
}
template <class First, class... Rest>
Parts<First, Rest...> part(Index count, const First& kernel, const Parts<Rest...>& rest) {
  return {threads_for<First>(count), kernel, rest};
}

/// kernel(i) for every i in [0, count), and note() of the least that they return, on a device.
template <class Kernel, class Note>
void for_each_noting([[maybe_unused]] const Exec& exec, Index items, const Kernel& kernel,
                     const Note& note) {
  const Index count = threads_for<Kernel>(items);
#if defined(__CUDACC__)
  if (exec.space == Space::cuda) {
    constexpr int threads = 128;
    return launch(kernel, launch_and_note<threads, Kernel, Note>, (count + threads - 1) / threads,
                  threads, count, kernel, note);
  }
#endif
  BR_ASSERT(exec.space == Space::shadow);
  launch_in_shadow(count, kernel, note);
}

}  // namespace loops
}  // namespace breccia
