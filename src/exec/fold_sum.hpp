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
  static constexpr Index most_blocks = 264, room = 2048;

  const Exec& exec_;
  Value whole_{};
  Buffer<Value> partial_;  ///< of each block of launches so far; the last place is for their sum
  Index used_ = 0;
};

}  // namespace loops
}  // namespace breccia
