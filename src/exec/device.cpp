#include "exec/device.hpp"

#include <cstdint>

#include "exec/error.hpp"
#include "exec/multiprocessors.hpp"

#if defined(BR_CUDA)
#include <future>

#include "exec/cuda.hpp"

namespace breccia {

void check_device(cudaError_t result, const char* what) {
  if (result == cudaSuccess) return;
  const std::string reason = cudaGetErrorString(result);
  throw DeviceError("the GPU failed in " + std::string(what) + ": " + reason);
}

namespace {
int used_device = -1;  ///< none yet
thread_local bool on_second_stream = false;

/// The number of the GPU that another thread makes ready. In a function, so that it ends before
/// CUDA does.
std::future<int>& coming_device() {
  static std::future<int> coming;
  return coming;
}

cudaStream_t made_stream() {
  await_device();
  cudaStream_t made = nullptr;
  check_device(cudaStreamCreateWithFlags(&made, cudaStreamNonBlocking), "making a stream");
  return made;
}

/// CUDA itself says that the driver is too old where there is none.
std::string why_no_gpu(cudaError_t result) {
  int driver = 0;
  const bool none = cudaDriverGetVersion(&driver) == cudaSuccess && driver == 0;
  return none ? "this machine has no NVIDIA driver" : cudaGetErrorString(result);
}

/// @returns the number of the GPU
int make_ready(int number, bool in_turn) {
  int count = 0;
  if (const cudaError_t result = cudaGetDeviceCount(&count); result != cudaSuccess)
    throw DeviceError("no GPU can be used: " + why_no_gpu(result) +
                      "; nothing was run\n  use --device cpu, or look at nvidia-smi");
  if (in_turn && count > 0) number %= count;
  if (number < 0 || number >= count)
    throw DeviceError("there is no GPU " + std::to_string(number) + "; this machine has " +
                      std::to_string(count) + ", from 0; nothing was run");
  check_device(cudaSetDevice(number), "choosing it");
  // Freed memory stays with the process: searches take and give arrays every few steps.
  cudaMemPool_t pool = nullptr;
  check_device(cudaDeviceGetDefaultMemPool(&pool, number), "finding its memory pool");
  std::uint64_t kept = ~std::uint64_t{0};
  check_device(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &kept),
               "setting its memory pool up");
  return number;
}
}  // namespace

void await_device() {
  if (!coming_device().valid()) return;
  used_device = coming_device().get();
  check_device(cudaSetDevice(used_device), "choosing it");  // each thread has to
}

cudaStream_t device_stream() {
  static const cudaStream_t run = made_stream();
  if (!on_second_stream) return run;
  static const cudaStream_t second = made_stream();
  return second;
}

SecondStream::SecondStream() {
  if (used_device < 0) return;
  check_device(cudaSetDevice(used_device), "choosing it");  // each thread has to
  on_second_stream = true;
}
SecondStream::~SecondStream() {
  on_second_stream = false;
}

int device_count() {
  int count = 0;
  if (cudaGetDeviceCount(&count) != cudaSuccess) cudaGetLastError();  // use_device() tells why
  return count;
}

bool launches_overlap() {
  static const bool can = [] {
    int number = 0, major = 0;
    check_device(cudaGetDevice(&number), "asking for its number");
    check_device(cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, number),
                 "asking for its properties");
    return major >= 9;
  }();
  return can;
}

void use_device(int number) {
  coming_device() = std::async(std::launch::async, make_ready, number, false);
}
void use_device_in_turn(int turn) {
  coming_device() = std::async(std::launch::async, make_ready, turn, true);
}

int device_in_use() {
  await_device();
  return used_device;
}

DeviceInfo device_info() {
  await_device();
  int number = 0;
  check_device(cudaGetDevice(&number), "asking for its number");
  cudaDeviceProp properties{};
  check_device(cudaGetDeviceProperties(&properties, number), "asking for its properties");
  DeviceInfo info;
  info.name = properties.name;
  check_device(cudaMemGetInfo(&info.free_memory, &info.memory), "asking for its memory");
  return info;
}

void return_free_memory() {
  int number = 0;
  cudaMemPool_t pool = nullptr;
  wait_for_device();
  check_device(cudaGetDevice(&number), "asking for its number");
  check_device(cudaDeviceGetDefaultMemPool(&pool, number), "finding its memory pool");
  check_device(cudaMemPoolTrimTo(pool, 0), "giving memory back");
}

Multiprocessors multiprocessors() {
  await_device();
  int number = 0, count = 0, memory = 0, resident = 0;
  check_device(cudaGetDevice(&number), "asking for its number");
  const auto ask = [&](cudaDeviceAttr what, int& answer) {
    check_device(cudaDeviceGetAttribute(&answer, what, number), "asking for its multiprocessors");
  };
  ask(cudaDevAttrMultiProcessorCount, count);
  ask(cudaDevAttrMaxSharedMemoryPerBlockOptin, memory);
  ask(cudaDevAttrCooperativeLaunch, resident);
  if (resident == 0) return {};
  constexpr int kept = 2048;  // for what kernels declare of it
  return {count, static_cast<std::size_t>(memory - kept)};
}

void wait_for_device() {
  check_device(cudaStreamSynchronize(device_stream()), "a kernel");
}

}  // namespace breccia

#else

namespace breccia {
namespace {
[[noreturn]] void refuse() {
  throw DeviceError(
      "this build of breccia has no CUDA; nothing was run\n"
      "  install the package breccia-cuda, build it with 'cmake --preset cuda', or use --device "
      "cpu");
}
}  // namespace

int device_count() {
  return 0;
}
void use_device(int) {
  refuse();
}
void use_device_in_turn(int) {
  refuse();
}
void await_device() {}
int device_in_use() {
  return -1;
}
DeviceInfo device_info() {
  refuse();
}
void return_free_memory() {}
Multiprocessors multiprocessors() {
  return {};
}
void wait_for_device() {}
SecondStream::SecondStream() = default;
SecondStream::~SecondStream() = default;

}  // namespace breccia
#endif
