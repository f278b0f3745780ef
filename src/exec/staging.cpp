#include "exec/staging.hpp"

#include <new>
#include <utility>

#include "exec/memory.hpp"

#if defined(BR_CUDA)
#include "exec/cuda.hpp"
#endif

namespace breccia {

void Staging::make_room(Space space, std::size_t bytes) {
  if (bytes <= size_ && space == beyond_) return;
  give_up();
  beyond_ = space;
#if defined(BR_CUDA)
  if (space == Space::cuda) {
    void* memory = nullptr;
    const cudaError_t result = cudaHostAlloc(&memory, bytes, cudaHostAllocPortable);
    if (result == cudaErrorMemoryAllocation) {
      cudaGetLastError();  // the failure is told here, not by the next call
      throw std::bad_alloc();
    }
    check_device(result, "locking memory of the host");
    data_ = static_cast<std::byte*>(memory);
    size_ = bytes;
    return;
  }
#endif
  data_ = static_cast<std::byte*>(allocate(Space::host, bytes));
  size_ = bytes;
}

void Staging::give_up() noexcept {
  if (data_ == nullptr) return;
#if defined(BR_CUDA)
  if (beyond_ == Space::cuda)
    cudaFreeHost(data_);
  else
#endif
    release(Space::host, data_);
  data_ = nullptr;
  size_ = 0;
}

void Staging::swap(Staging& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(beyond_, other.beyond_);
}

}  // namespace breccia
