#pragma once
// Reads that a kernel starts where they stand: the compiler moves them past no other one, and past
// no wait.

#include "exec/types.hpp"

namespace breccia {

#if defined(__CUDACC__)
/// A number.
__device__ inline double read_now(const double* from) {
  double value;
  asm volatile("ld.global.f64 %0, [%1];" : "=d"(value) : "l"(__cvta_generic_to_global(from)));
  return value;
}
__device__ inline float read_now(const float* from) {
  float value;
  asm volatile("ld.global.f32 %0, [%1];" : "=f"(value) : "l"(__cvta_generic_to_global(from)));
  return value;
}
__device__ inline Index read_now(const Index* from) {
  Index value;
  asm volatile("ld.global.s32 %0, [%1];" : "=r"(value) : "l"(__cvta_generic_to_global(from)));
  return value;
}
/// A record of doubles at an address that is a multiple of 16 B.
template <class Record>
__device__ inline Record read_record_now(const Record* from) {
  static_assert(sizeof(Record) % 16 == 0);
  double numbers[sizeof(Record) / 8];
#pragma unroll
  for (std::size_t k = 0; k < sizeof(Record) / 8; k += 2)
    asm volatile("ld.global.v2.f64 {%0, %1}, [%2];"
                 : "=d"(numbers[k]), "=d"(numbers[k + 1])
                 : "l"(__cvta_generic_to_global(reinterpret_cast<const double*>(from) + k)));
  Record record;
  __builtin_memcpy(&record, numbers, sizeof record);
  return record;
}
#endif

}  // namespace breccia
