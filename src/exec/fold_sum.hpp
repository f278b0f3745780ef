#pragma once
// The sum of what several kernels find: on a device a launch for each, and one look at the end.

#include "exec/for_each.hpp"

namespace breccia {
#if defined(BR_CUDA) && !defined(__CUDACC__)
inline namespace host_loops {
#else
inline namespace loops {
#endif

/// Sums that the blocks of launches found.
template <class Value>
struct FoundByBlocks {
  static constexpr const char* name = "exec.fold_sum";
  View<const Value> found;
  BR_HD Value operator()(Index block) const { return found[block]; }
};

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
    value = value + item_value(Value{}, parts.kernel, i);
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
  for (unsigned half = block_size / 2; half > 0; half /= 2) {
    __syncthreads();
    if (threadIdx.x < half) shared[threadIdx.x] = shared[threadIdx.x] + shared[threadIdx.x + half];
  }
  if (threadIdx.x == 0) partial[blockIdx.x] = shared[0];
}
#endif

/// Sums of kernels as `fold` takes them. Their order must not matter (whole numbers, ExactSum).
template <class Value>
class FoldSum {
 public:
  explicit FoldSum(const Exec& exec) : exec_(exec), partial_(exec.space) {}

  template <class Kernel>
  void add(Index count, const Kernel& kernel) {
    if (count <= 0) return;
#if defined(__CUDACC__)
    if (exec_.space == Space::cuda) {
      const Index blocks = std::min((count + block_size - 1) / block_size, most_blocks);
      if (used_ + blocks > room) whole_ = sum();
      partial_.reserve(room + 1);
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
      partial_.reserve(room + 1);
      launch(parts, fold_parts<Value, Parts<Kernels...>>, blocks, block_size, parts, most_blocks,
             partial_.data() + used_);
      used_ += blocks;
      return;
    }
#endif
    parts.each([&](Index count, const auto& kernel) { add(count, kernel); });
  }

  /// Of all kernels so far.
  Value sum() {
#if defined(__CUDACC__)
    if (used_ > 0) {
      FoundByBlocks<Value> all;
      all.found.data = partial_.data();
      all.found.size = used_;
      launch(all, fold_blocks<Value, FoundByBlocks<Value>, Sum>, 1, block_size, used_, Value{}, all,
             Sum{}, partial_.data() + room);
      Value more;
      copy_bytes(&more, Space::host, partial_.data() + room, Space::cuda, sizeof more);
      whole_ = whole_ + more;
      used_ = 0;
    }
#endif
    return whole_;
  }

 private:
  static constexpr Index most_blocks = 264, room = 4096;

  const Exec& exec_;
  Value whole_{};
  Buffer<Value> partial_;  ///< of each block of launches so far; the last place is for their sum
  Index used_ = 0;
};

}  // namespace loops
}  // namespace breccia
