// Loaded before a program of CUDA's static runtime (LD_PRELOAD), it stands between that runtime and
// the driver: one call fails, the device is lost, or a bit of its memory flips. With
// GPU_FAULT_SERVE the program's main is called again and again, which spares its start on the
// device: a line of standard input is "K STAYS LOG", then the command line, a tab before each of
// its words; the answer is a line "CODE ALLOCATIONS ALIVE" with the arrays of device and pinned
// memory that were not freed.
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
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

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
std::map<Word, Word> pinned;  ///< of the host, alike
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

std::atomic<long> failing{number("GPU_FAULT_ALLOC")}, stays{number("GPU_FAULT_STAYS")};

enum Kind { device_memory, pinned_memory, freed, graph, kernel, other };

bool fails(Kind kind, Result& result) {
  static const long lost = number("GPU_FAULT_LOST"), flipped = number("GPU_FAULT_FLIP"),
                    at_kernel = number("GPU_FAULT_FLIP_KERNEL");
  if (kind == device_memory || kind == pinned_memory) {
    const long k = ++allocations;
    result = out_of_memory;
    return failing > 0 && (k == failing || (stays != 0 && k > failing));
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
    if (arrays.erase(a) == 0) pinned.erase(a);
  }
  result = real_calls[place](a, b, c, d, e, f, g, h, i, j, k);
  if ((kinds[place] == device_memory || kinds[place] == pinned_memory) && result == 0) {
    const std::lock_guard lock(of_arrays);
    (kinds[place] == device_memory ? arrays : pinned)[*reinterpret_cast<Word*>(a)] = b;
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
                                                    {"cuMemFreeHost", freed},
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

using Main = int (*)(int, char**, char**);
Main real_main = nullptr;

/// Calls the program for each line that comes. What it prints goes to the file that the line names.
int serve(int, char** argv, char** environment) {
  const int in = ::dup(STDIN_FILENO), out = ::dup(STDOUT_FILENO);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  FILE* const lines = ::fdopen(in, "r");
  char* line = nullptr;
  std::size_t room = 0;
  for (ssize_t length = 0; (length = ::getline(&line, &room, lines)) > 0;) {
    std::istringstream text(std::string(line, static_cast<std::size_t>(length) - 1));
    long alloc = 0, from_then_on = 0;
    std::string log, word;
    text >> alloc >> from_then_on >> log;
    std::getline(text, word, '\t');
    std::vector<std::string> words{argv[0]};
    while (std::getline(text, word, '\t')) words.push_back(word);
    std::vector<char*> pointers;
    for (std::string& each : words) pointers.push_back(each.data());
    pointers.push_back(nullptr);
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    ::close(file);
    allocations = 0;
    stays = from_then_on;
    failing = alloc;
    const int code = real_main(static_cast<int>(words.size()), pointers.data(), environment);
    failing = 0;
    ::fflush(nullptr);
    std::size_t alive = 0;
    {
      const std::lock_guard lock(of_arrays);
      alive = arrays.size() + pinned.size();
    }
    ::dprintf(out, "%d %ld %zu\n", code, allocations.load(), alive);
  }
  return 0;
}

}  // namespace

/// The C library's start of a program, which it tells its main.
extern "C" __attribute__((visibility("default"))) int __libc_start_main(
    Main main, int argc, char** argv, void (*init)(), void (*fini)(), void (*end)(), void* stack) {
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  void* found = ::dlvsym(RTLD_NEXT, "__libc_start_main", "GLIBC_2.34");
  if (found == nullptr) found = ::dlvsym(RTLD_NEXT, "__libc_start_main", "GLIBC_2.2.5");
  real_main = main;
  const bool serves = number("GPU_FAULT_SERVE") != 0;
  return reinterpret_cast<Start>(found)(serves ? serve : main, argc, argv, init, fini, end, stack);
}

extern "C" __attribute__((visibility("default"))) void* dlsym(void* library,
                                                              const char* name) noexcept {
  void* const found = real_dlsym()(library, name);
  if (found == nullptr || ::strncmp(name, "cuGetProcAddress", 16) != 0) return found;
  driver = library;
  real_finder = reinterpret_cast<Finder>(found);
  return reinterpret_cast<void*>(&finder);
}
