#pragma once
// Memory that the lanes of a group share.

#include "exec/lockstep.hpp"
#include "exec/space.hpp"

namespace breccia {

/// Memory that the lanes of a group write and read together, without values at first; on a device
/// that of the multiprocessor. All lanes of the warp make one; they wait (LaneGroup) before they
/// read what others have written, before it is written anew, and before they leave it.
template <class T, int width>
class GroupMemory {
 public:
#if defined(__CUDA_ARCH__)
  __device__ T& get() const {
    __shared__ T all[block_size / width];
    return all[threadIdx.x / width];
  }
#else
  GroupMemory() : first_(LaneGroup<width>().from(0, &own_)) {}
  GroupMemory(const GroupMemory&) = delete;
  GroupMemory& operator=(const GroupMemory&) = delete;
  T& get() const {
    return *first_;
  }

 private:
  T own_;
  T* first_;  ///< of the group's first lane
#endif
};

}  // namespace breccia
