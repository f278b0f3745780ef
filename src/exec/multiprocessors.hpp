#pragma once
// Launches whose blocks are all on a GPU at one time, one a multiprocessor, with its own memory.

#include <cstddef>

#include "exec/types.hpp"
#if defined(__CUDACC__)
#include "exec/cuda.hpp"
#endif

namespace breccia {

/// Of the GPU in use.
struct Multiprocessors {
  Index count = 0;
  std::size_t memory = 0;  ///< that a block can have of one  [B]
};
/// None without CUDA.
Multiprocessors multiprocessors();

#if defined(__CUDACC__)
/// Launches a kernel whose blocks may wait for each other.
/// @param bytes  of a multiprocessor's own memory, for each block
template <class Parameter>
void launch_resident(void (*kernel)(Parameter), Index blocks, Index threads, std::size_t bytes,
                     const std::remove_const_t<Parameter>& argument) {
  check_device(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                    static_cast<int>(bytes)),
               "asking for memory of multiprocessors");
  cudaLaunchAttribute together{};
  together.id = cudaLaunchAttributeCooperative;
  together.val.cooperative = 1;
  cudaLaunchConfig_t how{};
  how.gridDim = dim3(static_cast<unsigned>(blocks));
  how.blockDim = dim3(static_cast<unsigned>(threads));
  how.dynamicSmemBytes = bytes;
  how.stream = device_stream();
  how.attrs = &together;
  how.numAttrs = 1;
  check_device(cudaLaunchKernelEx(&how, kernel, argument), "a launch of tiles");
}
#endif

}  // namespace breccia
