#pragma once
// The words every kernel is written in: index types, the host-device mark, checked-build
// assertions.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#if defined(__CUDACC__)
#define BR_HD __host__ __device__
#define BR_UNROLL _Pragma("unroll")
#else
#define BR_HD
#define BR_UNROLL
#endif

/// A programmer's contract, tested in checked builds (BR_CHECKED) and free in all others.
#if defined(BR_CHECKED) && !defined(__CUDA_ARCH__)
#define BR_ASSERT(condition)                                                       \
  do {                                                                             \
    if (!(condition)) ::breccia::assertion_failed(#condition, __FILE__, __LINE__); \
  } while (false)
#else
#define BR_ASSERT(condition) \
  do {                       \
  } while (false)
#endif

namespace breccia {

/// Position in an array. Signed, 32 bit: a model holds at most 2^31 - 1 elements or links a rank.
using Index = std::int32_t;

/// A position as containers of the standard library count.
constexpr std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

/// Number of an element that no sort, rank or device changes.
using GlobalId = std::int32_t;

/// A pair of elements in one number: the lower global id in the high half.
using PairKey = std::uint64_t;

BR_HD constexpr PairKey pair_key(GlobalId a, GlobalId b) {
  const GlobalId low = a < b ? a : b, high = a < b ? b : a;
  return (static_cast<PairKey>(static_cast<std::uint32_t>(low)) << 32) |
         static_cast<std::uint32_t>(high);
}
BR_HD constexpr GlobalId low_id(PairKey key) {
  return static_cast<GlobalId>(key >> 32);
}
BR_HD constexpr GlobalId high_id(PairKey key) {
  return static_cast<GlobalId>(key & 0xffffffffULL);
}

[[noreturn, gnu::cold]] inline void assertion_failed(const char* condition, const char* file,
                                                     int line) {
  std::fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, condition);
  std::abort();
}

}  // namespace breccia
