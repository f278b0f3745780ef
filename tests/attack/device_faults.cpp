// Loaded before a program of CUDA's static runtime (LD_PRELOAD), it stands between that runtime and
// the driver: one call fails, the device is lost, or a bit of its memory flips.
//
//   GPU_FAULT_ALLOC=K   the K-th allocation (from 1) of device or pinned memory fails
//   GPU_FAULT_STAYS=1   and every one after it, too
//   GPU_FAULT_LOST=K    from the K-th launch, copy or wait on each fails, as a lost device answers
//   GPU_FAULT_FLIP=K    before the K-th launch of a graph a bit flips in an array of the device,
//   GPU_FAULT_FLIP_KERNEL=K  or before the K-th launch of a kernel (steps that record no graphs),
//   GPU_FAULT_SEED=S    drawn by S
//   GPU_FAULT_COUNT=F   writes the numbers of allocations, of launches, copies and waits, of
//   graphs,
//                       of kernels and of flipped bits to the file F at the end

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <utility>

namespace {

using Result = int;
using Word = std::uintptr_t;
/// As many arguments as any of them has: cuLaunchKernel's eleven. A function with fewer lets the
/// rest be.
using AnyCall = Result (*)(Word, Word, Word, Word, Word, Word, Word, Word, Word, Word, Word);
using Symbol = void* (*)(void*, const char*);

constexpr Result out_of_memory = 2, launch_failed = 719;

std::atomic<long> allocations{0}, calls{0}, graphs{0}, kernels{0}, flips{0};
std::map<Word, Word> arrays;  ///< of the device: first byte and size
std::mutex of_arrays;

long number(const char* name) {
  const char* const text = ::getenv(name);
  return text == nullptr ? 0 : ::atol(text);
}

Symbol real_dlsym() {
  static const auto found = [] {
    void* symbol = ::dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.34");
    if (symbol == nullptr) symbol = ::dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.2.5");
    return reinterpret_cast<Symbol>(symbol);
  }();
  return found;
}
void* driver = nullptr;
using PlainCall = Result (*)(Word, Word, Word);
PlainCall of_driver(const char* name) {
  return reinterpret_cast<PlainCall>(real_dlsym()(driver, name));
}

void flip() {
  const std::lock_guard lock(of_arrays);
  Word all = 0;
  for (const auto& [first, size] : arrays) all += size;
  if (all == 0) return;
  std::mt19937_64 random(static_cast<std::uint64_t>(number("GPU_FAULT_SEED")));
  Word at = random() % all;
  for (const auto& [first, size] : arrays) {
    if (at >= size) {
      at -= size;
      continue;
    }
    unsigned char byte = 0;
    of_driver("cuCtxSynchronize")(0, 0, 0);
    const Result read = of_driver("cuMemcpyDtoH_v2")(reinterpret_cast<Word>(&byte), first + at, 1);
    byte = static_cast<unsigned char>(byte ^ (1U << random() % 8));
    const Result written =
        of_driver("cuMemcpyHtoD_v2")(first + at, reinterpret_cast<Word>(&byte), 1);
    flips += read == 0 && written == 0;
    return;
  }
}

enum Kind { device_memory, pinned_memory, freed, graph, kernel, other };

bool fails(Kind kind, Result& result) {
  static const long alloc = number("GPU_FAULT_ALLOC"), stays = number("GPU_FAULT_STAYS"),
                    lost = number("GPU_FAULT_LOST"), flipped = number("GPU_FAULT_FLIP"),
                    at_kernel = number("GPU_FAULT_FLIP_KERNEL");
  if (kind == device_memory || kind == pinned_memory) {
    const long k = ++allocations;
    result = out_of_memory;
    return alloc > 0 && (k == alloc || (stays != 0 && k > alloc));
  }
  if (kind == freed) return false;
  if (kind == graph && ++graphs == flipped) flip();
  if (kind == kernel && ++kernels == at_kernel) flip();
  result = launch_failed;
  return ++calls >= lost && lost > 0;
}

/// The driver's functions that stand behind the wrappers, a place for each that was asked for.
constexpr int places = 32;
AnyCall real_calls[places];
Kind kinds[places];
int used = 0;

template <int place>
Result wrapper(Word a, Word b, Word c, Word d, Word e, Word f, Word g, Word h, Word i, Word j,
               Word k) {
  Result result = 0;
  if (fails(kinds[place], result)) return result;
  if (kinds[place] == freed) {
    const std::lock_guard lock(of_arrays);
    arrays.erase(a);
  }
  result = real_calls[place](a, b, c, d, e, f, g, h, i, j, k);
  if (kinds[place] == device_memory && result == 0) {
    const std::lock_guard lock(of_arrays);
    arrays[*reinterpret_cast<Word*>(a)] = b;
  }
  return result;
}
template <int... place>
AnyCall wrapper_at(int n, std::integer_sequence<int, place...>) {
  static constexpr AnyCall all[] = {&wrapper<place>...};
  return all[n];
}

void* wrapped(const char* name, void* real) {
  static const std::map<std::string, Kind> known = {{"cuMemAllocAsync", device_memory},
                                                    {"cuMemAlloc", device_memory},
                                                    {"cuMemHostAlloc", pinned_memory},
                                                    {"cuMemFreeAsync", freed},
                                                    {"cuMemFree", freed},
                                                    {"cuGraphLaunch", graph},
                                                    {"cuLaunchKernelEx", kernel},
                                                    {"cuLaunchKernel", kernel},
                                                    {"cuMemcpyAsync", other},
                                                    {"cuMemsetD8Async", other},
                                                    {"cuStreamSynchronize", other},
                                                    {"cuEventSynchronize", other}};
  const auto found = known.find(name);
  if (found == known.end() || real == nullptr) return real;
  static std::mutex taking;
  const std::lock_guard lock(taking);
  for (int n = 0; n < used; ++n)
    if (real_calls[n] == reinterpret_cast<AnyCall>(real))
      return reinterpret_cast<void*>(wrapper_at(n, std::make_integer_sequence<int, places>()));
  if (used == places) return real;
  real_calls[used] = reinterpret_cast<AnyCall>(real);
  kinds[used] = found->second;
  return reinterpret_cast<void*>(wrapper_at(used++, std::make_integer_sequence<int, places>()));
}

using Finder = Result (*)(const char*, void**, int, std::uint64_t, void*);
Finder real_finder = nullptr;

Result finder(const char* symbol, void** to, int version, std::uint64_t flags, void* status) {
  const Result result = real_finder(symbol, to, version, flags, status);
  if (result != 0 || to == nullptr) return result;
  if (::strcmp(symbol, "cuGetProcAddress") == 0)
    *to = reinterpret_cast<void*>(&finder);
  else
    *to = wrapped(symbol, *to);
  return result;
}

struct AtEnd {
  ~AtEnd() {
    const char* const path = ::getenv("GPU_FAULT_COUNT");
    if (path == nullptr) return;
    if (FILE* const file = ::fopen(path, "w")) {
      ::fprintf(file, "%ld %ld %ld %ld %ld\n", allocations.load(), calls.load(), graphs.load(),
                kernels.load(), flips.load());
      ::fclose(file);
    }
  }
} at_end;

}  // namespace

extern "C" __attribute__((visibility("default"))) void* dlsym(void* library,
                                                              const char* name) noexcept {
  void* const found = real_dlsym()(library, name);
  if (found == nullptr || ::strncmp(name, "cuGetProcAddress", 16) != 0) return found;
  driver = library;
  real_finder = reinterpret_cast<Finder>(found);
  return reinterpret_cast<void*>(&finder);
}
