#pragma once
// Lanes of a device on the processor: kernels that give several threads to one item run there, too,
// so that tests without a GPU cover them.

#include <cstddef>
#include <cstring>

#include "exec/types.hpp"

namespace breccia {

namespace lockstep {

inline constexpr int lanes = 32;

/// Calls work(context, lane) for the lanes of a warp, each on a stack of its own on this thread. A
/// lane that calls exchange() waits there until all others have called it, too.
void run(void (*work)(void* context, int lane), void* context);

/// Number of the lane that runs on this thread; 0 outside of run().
int lane();

/// Hands 8 bytes over. @returns those of each lane; valid until this lane's next exchange but one
const double* exchange(double own);

}  // namespace lockstep

/// Threads of whole warps, as many as `threads` need.
BR_HD constexpr Index whole_warps(Index threads) {
  return (threads + lockstep::lanes - 1) / lockstep::lanes * lockstep::lanes;
}

/// The neighbouring lanes of a warp that work on one item, `width` of them. All lanes of the warp
/// call each function, in the same order: those of groups that have nothing to do go along. A
/// device then need not find out which lanes are there, and groups do not wait for each other's
/// turn.
template <int width>
class LaneGroup {
 public:
  static_assert(width < lockstep::lanes && lockstep::lanes % width == 0);

  BR_HD LaneGroup() {
#if defined(__CUDA_ARCH__)
    first_ = static_cast<int>(threadIdx.x % 32 / width * width);
#else
    first_ = lockstep::lane() / width * width;
#endif
  }
  /// x of lane `of`.
  template <class T>
  BR_HD T from(int of, T x) const {
#if defined(__CUDA_ARCH__)
    return __shfl_sync(~0U, x, of, width);
#else
    static_assert(sizeof(T) <= sizeof(double));
    double sent = 0.0;
    std::memcpy(&sent, &x, sizeof x);
    const double* const all = lockstep::exchange(sent);
    std::memcpy(&x, all + first_ + of % width, sizeof x);
    return x;
#endif
  }
#if !defined(__CUDA_ARCH__)
  /// The record of lane `of`, which each lane leaves as it is until its next call. On a device each
  /// number takes a call of its own.
  template <class T>
  T record_from(int of, const T& own) const {
    const T* const place = &own;
    static_assert(sizeof place == sizeof(double));
    double sent = 0.0;
    std::memcpy(&sent, &place, sizeof place);
    const T* other = nullptr;
    std::memcpy(&other, lockstep::exchange(sent) + first_ + of % width, sizeof other);
    return *other;
  }
#endif
  /// Bit k: `flag` of lane k.
  BR_HD unsigned ballot(bool flag) const {
#if defined(__CUDA_ARCH__)
    return __ballot_sync(~0U, flag) >> first_ & ((1U << width) - 1U);
#else
    const double* const all = lockstep::exchange(flag ? 1.0 : 0.0) + first_;
    unsigned bits = 0;
    for (int k = 0; k < width; ++k) bits |= all[k] > 0.0 ? 1U << k : 0U;
    return bits;
#endif
  }
  /// Whether a lane of any group of the warp has `flag`: where one has work, all go there.
  BR_HD bool any_of_warp(bool flag) const {
#if defined(__CUDA_ARCH__)
    return __any_sync(~0U, flag) != 0;
#else
    const double* const all = lockstep::exchange(flag ? 1.0 : 0.0);
    bool any = false;
    for (int k = 0; k < lockstep::lanes; ++k) any = any || all[k] > 0.0;
    return any;
#endif
  }
  /// Waits until all lanes are here: each then sees what the others wrote before.
  BR_HD void wait() const {
#if defined(__CUDA_ARCH__)
    __syncwarp();
#else
    lockstep::exchange(0.0);
#endif
  }

 private:
  int first_ = 0;  ///< of the group's lanes
};

}  // namespace breccia
