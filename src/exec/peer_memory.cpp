#include "exec/peer_memory.hpp"

#include <cstring>

#include "exec/memory.hpp"

#if defined(BR_CUDA)
#include "exec/cuda.hpp"
#endif

namespace breccia {

std::unique_ptr<PeerMemory> PeerMemory::make(Space space, std::size_t bytes) {
  std::unique_ptr<PeerMemory> made(new PeerMemory(space, true));
  return made->take(bytes) ? std::move(made) : nullptr;
}

std::unique_ptr<PeerMemory> PeerMemory::open(Space space, const PeerPass& pass) {
  if (!pass.valid) return nullptr;
  std::unique_ptr<PeerMemory> opened(new PeerMemory(space, false));
  return opened->reach(pass) ? std::move(opened) : nullptr;
}

#if defined(BR_CUDA)
namespace {

/// A call that may fail: its error is forgotten, and not told by the next one.
bool went_well(cudaError_t result) {
  if (result == cudaSuccess) return true;
  cudaGetLastError();
  return false;
}
cudaEvent_t event(void* moment) {
  return static_cast<cudaEvent_t>(moment);
}

}  // namespace
#endif

bool PeerMemory::take(std::size_t bytes) {
  if (space_ != Space::cuda) {
    data_ = static_cast<std::byte*>(allocate(space_, bytes));
    std::memcpy(pass_.memory, &data_, sizeof data_);
    return pass_.valid = true;
  }
#if defined(BR_CUDA)
  // Whole pages: what a process shares it shares by the page. cudaMallocAsync's cannot be shared.
  constexpr std::size_t page = std::size_t{2} << 20;
  void* memory = nullptr;
  if (!went_well(cudaMalloc(&memory, (bytes + page - 1) / page * page))) return false;
  data_ = static_cast<std::byte*>(memory);
  cudaIpcMemHandle_t of_memory{};
  static_assert(sizeof of_memory == sizeof pass_.memory);
  if (!went_well(cudaIpcGetMemHandle(&of_memory, memory))) return false;
  std::memcpy(pass_.memory, &of_memory, sizeof of_memory);
  for (int k = 0; k < PeerPass::moments; ++k) {
    cudaEvent_t made = nullptr;
    cudaIpcEventHandle_t of_event{};
    static_assert(sizeof of_event == sizeof pass_.moment[0]);
    if (!went_well(cudaEventCreateWithFlags(&made, cudaEventDisableTiming | cudaEventInterprocess)))
      return false;
    moment_[k] = made;
    if (!went_well(cudaIpcGetEventHandle(&of_event, made))) return false;
    std::memcpy(pass_.moment[k], &of_event, sizeof of_event);
  }
  return pass_.valid = true;
#else
  return false;
#endif
}

bool PeerMemory::reach(const PeerPass& pass) {
  if (space_ != Space::cuda) {
    std::memcpy(&data_, pass.memory, sizeof data_);
    return true;
  }
#if defined(BR_CUDA)
  cudaIpcMemHandle_t of_memory{};
  std::memcpy(&of_memory, pass.memory, sizeof of_memory);
  void* memory = nullptr;
  if (!went_well(cudaIpcOpenMemHandle(&memory, of_memory, cudaIpcMemLazyEnablePeerAccess)))
    return false;
  data_ = static_cast<std::byte*>(memory);
  for (int k = 0; k < PeerPass::moments; ++k) {
    cudaIpcEventHandle_t of_event{};
    std::memcpy(&of_event, pass.moment[k], sizeof of_event);
    cudaEvent_t opened = nullptr;
    if (!went_well(cudaIpcOpenEventHandle(&opened, of_event))) return false;
    moment_[k] = opened;
  }
  return true;
#else
  return false;
#endif
}

PeerMemory::~PeerMemory() {
  if (data_ == nullptr) return;
  if (space_ != Space::cuda) {
    if (own_) release(space_, data_);
    return;
  }
#if defined(BR_CUDA)
  for (void* moment : moment_)
    if (moment != nullptr) cudaEventDestroy(event(moment));
  own_ ? cudaFree(data_) : cudaIpcCloseMemHandle(data_);
#endif
}

void PeerMemory::mark([[maybe_unused]] int k) const {
#if defined(BR_CUDA)
  if (space_ == Space::cuda)
    check_device(cudaEventRecord(event(moment_[k]), device_stream()), "marking a moment");
#endif
}

void PeerMemory::follow([[maybe_unused]] int k) const {
#if defined(BR_CUDA)
  if (space_ == Space::cuda)
    check_device(cudaStreamWaitEvent(device_stream(), event(moment_[k]), 0),
                 "waiting for another one's moment");
#endif
}

}  // namespace breccia
