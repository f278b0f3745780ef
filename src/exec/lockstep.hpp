#pragma once
// Lanes of a device on the processor: kernels that give several threads to one item run there, too,
// so that tests without a GPU cover them.

#include <cstddef>
#include <cstring>

#include "exec/types.hpp"

namespace breccia {

namespace lockstep {

inline constexpr int most_lanes = 32;

/// Calls work(context, lane) for lanes 0 to `lanes` - 1, each on a stack of its own on this thread.
/// A lane that calls exchange() waits there until all others have called it, too.
void run(int lanes, void (*work)(void* context, int lane), void* context);

/// Number of the lane that runs on this thread; 0 outside of run().
int lane();

/// Hands 8 bytes over. @returns those of each lane; valid until this lane's next exchange but one
const double* exchange(double own);

}  // namespace lockstep

/// The neighbouring lanes of a warp that work on one item, `width` of them. All of them call each
/// function, in the same order.
/// @tparam together  lanes that call each function at a time: if all 32 of a warp do, nvcc need not
///                   find out which do
template <int width, int together = width>
class LaneGroup {
 public:
  BR_HD LaneGroup() {
#if defined(__CUDA_ARCH__)
    first_ = threadIdx.x / width * width % 32;
    mask_ = (together == 32 ? ~0U : ((1U << width % 32) - 1) << first_);
#endif
  }
  /// x of lane `of`.
  template <class T>
  BR_HD T from(int of, T x) const {
#if defined(__CUDA_ARCH__)
    return __shfl_sync(mask_, x, of, width);
#else
    static_assert(sizeof(T) <= sizeof(double));
    double sent = 0.0;
    std::memcpy(&sent, &x, sizeof x);
    const double* const all = lockstep::exchange(sent);
    std::memcpy(&x, all + of % width, sizeof x);
    return x;
#endif
  }
  /// Bit k: `flag` of lane k.
  BR_HD unsigned ballot(bool flag) const {
#if defined(__CUDA_ARCH__)
    return (__ballot_sync(mask_, flag) & mask_) >> first_;
#else
    const double* const all = lockstep::exchange(flag ? 1.0 : 0.0);
    unsigned bits = 0;
    for (int k = 0; k < width; ++k) bits |= all[k] > 0.0 ? 1U << k : 0U;
    return bits;
#endif
  }
  /// Waits until all lanes are here: each then sees what the others wrote before.
  BR_HD void wait() const {
#if defined(__CUDA_ARCH__)
    __syncwarp(mask_);
#else
    lockstep::exchange(0.0);
#endif
  }

 private:
  unsigned mask_ = 0, first_ = 0;
};

}  // namespace breccia
