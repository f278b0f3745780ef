#include "exec/memory.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

#include "exec/device.hpp"
#include "exec/filling.hpp"

#if defined(BR_CUDA)
#include <mutex>

#include "exec/cuda.hpp"
#include "exec/look.hpp"
#endif

namespace breccia {
namespace {

constexpr std::size_t alignment = 64;  // one cache line; the line before the array says how large
/// Arrays of so many bytes are mapped: as long as glibc's allocator would map them, too.
constexpr std::size_t mapped_from = std::size_t{1} << 25;
/// Arrays of a space that are alive, and the most that were.
struct Booked {
  std::atomic<std::size_t> alive{0}, peak{0};

  void add(std::size_t bytes) {
    const std::size_t now = alive += bytes;
    std::size_t most = peak.load();
    while (now > most && !peak.compare_exchange_weak(most, now)) {
    }
  }
};
/// Of the host and of the shadow, which both lie in the processor's memory.
Booked& booked(Space space) {
  static Booked of_host, of_shadow;
  return space == Space::shadow ? of_shadow : of_host;
}
thread_local int filling_threads = 1;

/// Memory that takes its pages, large ones where the system has them, as it is first written to;
/// null: there is none.
void* mapped_block(std::size_t bytes) {
  void* const block =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (block == MAP_FAILED) return nullptr;
  ::madvise(block, bytes, MADV_HUGEPAGE);  // advice alone
  return block;
}

/// fill(first, bytes) for portions that make up `bytes`, on the threads that fill arrays.
template <class Fill>
void by_portions(std::size_t bytes, const Fill& fill) {
  constexpr std::size_t portion = std::size_t{1} << 22;
  if (filling_threads == 1 || bytes < 2 * portion) return fill(std::size_t{0}, bytes);
  const auto parts = static_cast<int>((bytes + portion - 1) / portion);
  for_each_task(filling_threads, parts, [&](int part) {
    const std::size_t first = static_cast<std::size_t>(part) * portion;
    fill(first, std::min(portion, bytes - first));
  });
}

}  // namespace

void* allocate(Space space, std::size_t bytes) {
  if (space == Space::cuda) {
#if defined(BR_CUDA)
    void* memory = nullptr;
    const cudaError_t result = cudaMallocAsync(&memory, bytes, device_stream());
    if (result == cudaErrorMemoryAllocation) {
      cudaGetLastError();  // the failure is told here, not by the next call
      throw std::bad_alloc();
    }
    check_device(result, "taking memory");
    return memory;
#else
    throw std::bad_alloc();
#endif
  }
  const std::size_t padded = (bytes + 2 * alignment - 1) / alignment * alignment + alignment;
  auto* block = static_cast<std::byte*>(padded < mapped_from ? std::aligned_alloc(alignment, padded)
                                                             : mapped_block(padded));
  if (block == nullptr) throw std::bad_alloc();
  std::memcpy(block, &padded, sizeof padded);
  booked(space).add(padded);
  return block + alignment;
}

void release(Space space, void* memory) noexcept {
  if (memory == nullptr) return;
  if (space == Space::cuda) {
#if defined(BR_CUDA)
    cudaFreeAsync(memory, device_stream());
#endif
    return;
  }
  auto* block = static_cast<std::byte*>(memory) - alignment;
  std::size_t padded = 0;
  std::memcpy(&padded, block, sizeof padded);
  booked(space).alive -= padded;
  if (padded < mapped_from)
    std::free(block);
  else
    ::munmap(block, padded);
}

bool comes_zeroed(Space space, std::size_t bytes) {
  return space != Space::cuda && bytes >= mapped_from;
}

void* reserve_memory(std::size_t bytes) {
  void* const memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  return memory;
}

void release_reserved(void* memory, std::size_t bytes) noexcept {
  if (memory != nullptr) ::munmap(memory, bytes);
}

void copy_bytes(void* to, [[maybe_unused]] Space to_space, const void* from,
                [[maybe_unused]] Space from_space, std::size_t bytes) {
  if (bytes == 0) return;
#if defined(BR_CUDA)
  if (to_space != Space::cuda && from_space == Space::cuda && bytes <= most_told) {
    const Look look = next_look(0);  // by way of memory that the device knows
    check_device(cudaMemcpyAsync(look.told, from, bytes, cudaMemcpyDefault, device_stream()),
                 "a copy");
    wait_for_device();
    std::memcpy(to, look.told, bytes);
    return;
  }
  if (to_space == Space::cuda || from_space == Space::cuda) {
    check_device(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDefault, device_stream()), "a copy");
    if (to_space != from_space) wait_for_device();
    return;
  }
#endif
  by_portions(bytes, [&](std::size_t first, std::size_t size) {
    std::memcpy(static_cast<std::byte*>(to) + first, static_cast<const std::byte*>(from) + first,
                size);
  });
}

#if defined(BR_CUDA)
namespace {

/// A stream beside those of the run.
cudaStream_t beside() {
  static const cudaStream_t stream = [] {
    cudaStream_t made = nullptr;
    check_device(cudaStreamCreateWithFlags(&made, cudaStreamNonBlocking), "making a stream");
    return made;
  }();
  return stream;
}
/// The point that was marked last.
cudaEvent_t mark() {
  static const cudaEvent_t event = [] {
    cudaEvent_t made = nullptr;
    check_device(cudaEventCreateWithFlags(&made, cudaEventDisableTiming), "making an event");
    return made;
  }();
  return event;
}

}  // namespace
#endif

void peek_bytes(void* to, const void* from, [[maybe_unused]] Space from_space, std::size_t bytes) {
#if defined(BR_CUDA)
  if (from_space == Space::cuda) {
    static std::mutex one_at_a_time;
    static std::byte* const seen = [] {
      void* memory = nullptr;
      check_device(cudaHostAlloc(&memory, most_told, cudaHostAllocPortable), "locking memory");
      return static_cast<std::byte*>(memory);
    }();
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    void* const by = bytes <= most_told ? seen : to;
    check_device(cudaMemcpyAsync(by, from, bytes, cudaMemcpyDefault, beside()), "a look at memory");
    check_device(cudaStreamSynchronize(beside()), "a look at memory");
    if (by != to) std::memcpy(to, by, bytes);
    return;
  }
#endif
  std::memcpy(to, from, bytes);
}

void mark_launches([[maybe_unused]] Space space) {
#if defined(BR_CUDA)
  if (space == Space::cuda) check_device(cudaEventRecord(mark(), device_stream()), "a mark");
#endif
}

void peek_marked_bytes(void* to, const void* from, Space from_space, std::size_t bytes) {
#if defined(BR_CUDA)
  if (from_space == Space::cuda)
    check_device(cudaStreamWaitEvent(beside(), mark(), 0), "waiting for a mark");
#endif
  peek_bytes(to, from, from_space, bytes);
}

void clear_bytes(void* memory, [[maybe_unused]] Space space, std::size_t bytes) {
  if (bytes == 0) return;
#if defined(BR_CUDA)
  if (space == Space::cuda) {
    check_device(cudaMemsetAsync(memory, 0, bytes, device_stream()), "clearing memory");
    return;
  }
#endif
  by_portions(bytes, [=](std::size_t first, std::size_t size) {
    std::memset(static_cast<std::byte*>(memory) + first, 0, size);
  });
}

FillingThreads::FillingThreads(int threads)
    : before_(std::exchange(filling_threads, std::max(threads, 1))) {}
FillingThreads::~FillingThreads() {
  filling_threads = before_;
}

#if defined(BR_CUDA)
namespace {

cudaMemPool_t pool_in_use() {
  int number = 0;
  cudaMemPool_t pool = nullptr;
  check_device(cudaGetDevice(&number), "asking for its number");
  check_device(cudaDeviceGetDefaultMemPool(&pool, number), "finding its memory pool");
  return pool;
}

}  // namespace
#endif

std::size_t peak_array_bytes(Space space) {
#if defined(BR_CUDA)
  if (space == Space::cuda) {
    std::uint64_t bytes = 0;
    check_device(cudaMemPoolGetAttribute(pool_in_use(), cudaMemPoolAttrUsedMemHigh, &bytes),
                 "asking for its memory");
    return bytes;
  }
#endif
  return booked(space).peak.load();
}

void forget_peak_of_arrays(Space space) {
#if defined(BR_CUDA)
  if (space == Space::cuda) {
    std::uint64_t none = 0;  // the driver goes on from what is alive
    check_device(cudaMemPoolSetAttribute(pool_in_use(), cudaMemPoolAttrUsedMemHigh, &none),
                 "forgetting the most of its memory");
    return;
  }
#endif
  booked(space).peak = booked(space).alive.load();
}

}  // namespace breccia
