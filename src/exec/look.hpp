#pragma once
// Numbers that kernels tell the host: a kernel writes them into memory of the host that both see,
// and then a word for which the host waits. So a look costs neither a copy nor a wait for the rest
// of the stream. Only files that a CUDA build compiles include this header.

#include <cstddef>
#include <cstdint>

#include "exec/types.hpp"

namespace breccia {

/// Memory that the kernels of one look work with. Looks of a stream come one after the other, and
/// each tells in a place of its own, so that several can be on their way.
struct Look {
  std::byte* told;       ///< of the host: what is told
  std::uint32_t* word;   ///< of the host: number of the last look that was told
  std::uint32_t number;  ///< of this one
  std::uint32_t* ended;  ///< of the device: blocks that have ended; zero before and after
  std::byte* work;       ///< of the device: nothing of use is in it
};
/// Most bytes that a look tells.
inline constexpr std::size_t most_told = 4096;
/// Looks of a stream that can be on their way: what one has told is there until as many more begin.
inline constexpr std::uint32_t looks_on_their_way = 64;

/// The next look on the stream of this thread. @param work  bytes that its kernels work with
Look next_look(std::size_t work);
/// Waits until it has been told. @throws DeviceError if a kernel has failed
void wait_for(const Look& look);

#if defined(__CUDACC__)
/// Whether this block ends last; what all others have written is seen from here on. Called by all
/// threads of all blocks, after the last writes of each block's thread 0.
__device__ inline bool is_last_block(const Look& look) {
  __shared__ bool last;
  if (threadIdx.x == 0) {
    __threadfence();
    last = atomicAdd(look.ended, 1U) + 1U == gridDim.x;
    if (last) *look.ended = 0;
  }
  __syncthreads();
  if (last) __threadfence();
  return last;
}
/// Told by one thread.
template <class T>
__device__ void tell(const Look& look, const T& what) {
  static_assert(sizeof(T) <= most_told);
  *reinterpret_cast<T*>(look.told) = what;
  __threadfence_system();
  *reinterpret_cast<volatile std::uint32_t*>(look.word) = look.number;
}
#endif

}  // namespace breccia
