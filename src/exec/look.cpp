#include "exec/look.hpp"

#if defined(BR_CUDA)
#include <atomic>
#include <cstring>
#include <map>
#include <mutex>

#include "exec/cuda.hpp"
#include "exec/error.hpp"
#include "exec/memory.hpp"

namespace breccia {
namespace {

constexpr std::size_t bytes_of_look = most_told + 64;  ///< with its word, in a line of its own

/// Of one stream.
struct Place {
  Look look{};  ///< the last one
  std::byte* told = nullptr;
  std::size_t work = 0;

  Place() {
    void* memory = nullptr;
    check_device(cudaHostAlloc(&memory, looks_on_their_way * bytes_of_look,
                               cudaHostAllocMapped | cudaHostAllocPortable),
                 "taking memory that the host sees");
    std::memset(memory, 0, looks_on_their_way * bytes_of_look);
    told = static_cast<std::byte*>(memory);
    look.ended = static_cast<std::uint32_t*>(allocate(Space::cuda, sizeof(std::uint32_t)));
    clear_bytes(look.ended, Space::cuda, sizeof(std::uint32_t));
  }
};

/// Streams last as long as the program, and what their looks need likewise.
Place& place_of(cudaStream_t stream) {
  static std::mutex one_at_a_time;
  static std::map<cudaStream_t, Place*> places;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  Place*& place = places[stream];
  if (place == nullptr) place = new Place;
  return *place;
}

}  // namespace

Look next_look(std::size_t work) {
  Place& place = place_of(device_stream());
  if (work > place.work) {
    release(Space::cuda, place.look.work);
    place.look.work = nullptr;
    place.work = 0;
    place.look.work = static_cast<std::byte*>(allocate(Space::cuda, work + work / 2));
    place.work = work + work / 2;
  }
  Look& look = place.look;
  ++look.number;
  look.told = place.told + look.number % looks_on_their_way * bytes_of_look;
  look.word = reinterpret_cast<std::uint32_t*>(look.told + most_told);
  return look;
}

void wait_for(const Look& look) {
  BR_ASSERT(place_of(device_stream()).look.number - look.number < looks_on_their_way);
  const auto is_told = [&look] {
    return std::atomic_ref<std::uint32_t>(*look.word).load(std::memory_order_acquire) ==
           look.number;
  };
  for (unsigned turn = 1; !is_told(); ++turn) {
    if (turn % 8192 != 0) continue;
    const cudaError_t state = cudaStreamQuery(device_stream());
    if (state == cudaErrorNotReady) {
      cudaGetLastError();  // no failure, which CUB would take it for
      continue;
    }
    check_device(state, "a kernel");
    if (!is_told()) throw DeviceError("the GPU has not told what it was asked for");
  }
}

}  // namespace breccia
#endif
