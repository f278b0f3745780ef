#pragma once
// The sum of what several kernels find: on a device a launch for each, and one look at the end.

#include <functional>

#include "exec/for_each.hpp"

namespace breccia {
#if defined(BR_CUDA) && !defined(__CUDACC__)
inline namespace host_loops {
#else
inline namespace loops {
#endif

/// Blocks of each part of a launch that sums what the parts' items have.
inline Index blocks_to_fold(const Parts<>&, Index) {
  return 0;
}
template <class First, class... Rest>
Index blocks_to_fold(const Parts<First, Rest...>& parts, Index most) {
  return std::min(parts.own_blocks(), most) + blocks_to_fold(parts.rest, most);
}
#if defined(__CUDACC__)
template <class Value>
__device__ void fold_part(const Parts<>&, Index, Index, Value&) {}
/// Adds to `value` what a thread of `block` finds.
template <class Value, class First, class... Rest>
__device__ void fold_part(const Parts<First, Rest...>& parts, Index block, Index most,
                          Value& value) {
  const Index blocks = min(parts.own_blocks(), most);
  if (block >= blocks) return fold_part(parts.rest, block - blocks, most, value);
  for (Index i = block * block_size + static_cast<Index>(threadIdx.x); i < parts.count;
       i += blocks * block_size)
    add_item(value, parts.kernel, i, Sum{});
}
/// fold_blocks() of several kernels.
template <class Value, class All>
__global__ void __launch_bounds__(block_size)
    fold_parts(const __grid_constant__ All all, Index most, Value* partial) {
  follow_previous();
  __shared__ alignas(16) unsigned char memory[block_size * sizeof(Value)];
  auto* shared = reinterpret_cast<Value*>(memory);
  shared[threadIdx.x] = Value{};  // not in registers: as in fold_blocks()
  fold_part(all, static_cast<Index>(blockIdx.x), most, shared[threadIdx.x]);
  combine_block(Sum{}, shared);
  if (threadIdx.x == 0) partial[blockIdx.x] = shared[0];
}
#endif

/// Sums of kernels as `fold` takes them. Their order must not matter (whole numbers, ExactSum).
template <class Value>
class FoldSum {
 public:
  static constexpr const char* name = "exec.fold_sum";

  explicit FoldSum(const Exec& exec) : exec_(exec), partial_(exec.space) {}

  template <class Kernel>
  void add(Index count, const Kernel& kernel) {
    if (count <= 0) return;
#if defined(__CUDACC__)
    if (exec_.space == Space::cuda) {
      const Index blocks = std::min((count + block_size - 1) / block_size, most_blocks);
      if (used_ + blocks > room) whole_ = sum();
      partial_.reserve(room);
      launch(kernel, fold_blocks<Value, Kernel, Sum>, blocks, block_size, count, Value{}, kernel,
             Sum{}, partial_.data() + used_);
      used_ += blocks;
      return;
    }
#endif
    whole_ = whole_ + fold(exec_, count, Value{}, kernel, Sum{});
  }

  /// Several kernels, `part(count, kernel, rest)`: on a device by one launch.
  template <class... Kernels>
  void add_parts(const Parts<Kernels...>& parts) {
#if defined(__CUDACC__)
    if (exec_.space == Space::cuda) {
      const Index blocks = blocks_to_fold(parts, most_blocks);
      if (blocks == 0) return;
      static_assert(sizeof...(Kernels) * most_blocks <= room);
      if (used_ + blocks > room) whole_ = sum();
      partial_.reserve(room);
      launch(parts, fold_parts<Value, Parts<Kernels...>>, blocks, block_size, parts, most_blocks,
             partial_.data() + used_);
      used_ += blocks;
      return;
    }
#endif
    parts.each([&](Index count, const auto& kernel) { add(count, kernel); });
  }

  /// Of all kernels so far, when it is asked for: until then the host can go on.
  std::function<Value()> sum_later() {
#if defined(__CUDACC__)
    if (used_ > 0) {
      const Look look = next_look(0);
      launch(*this, tell_found<Value, Sum>, 1, block_size, partial_.data(), used_, Value{}, Sum{},
             look);
      used_ = 0;
      return [whole = whole_, more = Later<Value>(Value{}, look)] { return whole + more.value(); };
    }
#endif
    return [whole = whole_] { return whole; };
  }
  /// Of all kernels so far.
  Value sum() {
    return sum_later()();
  }

 private:
  static constexpr Index most_blocks = 264, room = 4096;

  const Exec& exec_;
  Value whole_{};
  Buffer<Value> partial_;  ///< of each block of launches so far
  Index used_ = 0;
};

}  // namespace loops
}  // namespace breccia
