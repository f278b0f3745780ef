#pragma once
// Volatile loads: on a device the compiler must not reorder them with each other or with a wait for
// the launch before. On the host they are plain.

#include "exec/buffer.hpp"
#include "exec/space.hpp"
#include "exec/types.hpp"

namespace breccia {

/// Loads a number where this call stands.
BR_HD inline double read_now(const double* from) {
#if defined(__CUDA_ARCH__)
  double value;
  asm volatile("ld.global.f64 %0, [%1];" : "=d"(value) : "l"(__cvta_generic_to_global(from)));
  return value;
#else
  return *from;
#endif
}
BR_HD inline float read_now(const float* from) {
#if defined(__CUDA_ARCH__)
  float value;
  asm volatile("ld.global.f32 %0, [%1];" : "=f"(value) : "l"(__cvta_generic_to_global(from)));
  return value;
#else
  return *from;
#endif
}
BR_HD inline Index read_now(const Index* from) {
#if defined(__CUDA_ARCH__)
  Index value;
  asm volatile("ld.global.s32 %0, [%1];" : "=r"(value) : "l"(__cvta_generic_to_global(from)));
  return value;
#else
  return *from;
#endif
}
BR_HD inline std::uint8_t read_now(const std::uint8_t* from) {
#if defined(__CUDA_ARCH__)
  unsigned byte;
  asm volatile("ld.global.u8 %0, [%1];" : "=r"(byte) : "l"(__cvta_generic_to_global(from)));
  return static_cast<std::uint8_t>(byte);
#else
  return *from;
#endif
}
/// Loads a record of doubles at an address that is a multiple of 16 B.
template <class Record>
BR_HD inline Record read_record_now(const Record* from) {
  static_assert(sizeof(Record) % 16 == 0);
#if defined(__CUDA_ARCH__)
  double numbers[sizeof(Record) / 8];
#pragma unroll
  for (std::size_t k = 0; k < sizeof(Record) / 8; k += 2)
    asm volatile("ld.global.v2.f64 {%0, %1}, [%2];"
                 : "=d"(numbers[k]), "=d"(numbers[k + 1])
                 : "l"(__cvta_generic_to_global(reinterpret_cast<const double*>(from) + k)));
  Record record;
  __builtin_memcpy(&record, numbers, sizeof record);
  return record;
#else
  return *from;
#endif
}

/// The lanes of a warp see what each has written before.
BR_HD inline void wait_for_warp() {
#if defined(__CUDA_ARCH__)
  __syncwarp();
#endif
}

#if defined(__CUDA_ARCH__)
/// Records of neighbours that the threads of a warp read or write together: their run of memory in
/// whole lines, exchanged by way of the multiprocessor's own memory. If each thread took its own,
/// every line would be asked for once for each 16 B. All items of the array have a thread.
template <class Record>
class WarpRecords {
 public:
  /// Record i of thread i: the reads begin,
  __device__ void read(const View<const Record>& from, Index i) {
    const Index first = i - lane();
    if (first + 32 > from.size) return ask(from.data + i, 1);
    const auto* const run = reinterpret_cast<const Part*>(from.data + first);
    ask(reinterpret_cast<const Record*>(run + lane()), 32);
    exchanged_ = true;
  }
  /// and have ended.
  __device__ Record own() {
    if (exchanged_) {
      Part* const place = memory();
#pragma unroll
      for (int k = 0; k < parts; ++k) place[k * 32 + lane()] = part_[k];
      __syncwarp();
#pragma unroll
      for (int k = 0; k < parts; ++k) part_[k] = place[lane() * parts + k];
      __syncwarp();
    }
    Record record;
    __builtin_memcpy(&record, part_, sizeof record);
    return record;
  }
  __device__ static void write(const View<Record>& to, Index i, const Record& own) {
    const Index first = i - lane();
    if (first + 32 > to.size) {
      to[i] = own;
      return;
    }
    Part part[parts];
    __builtin_memcpy(part, &own, sizeof own);
    Part* const place = memory();
#pragma unroll
    for (int k = 0; k < parts; ++k) place[lane() * parts + k] = part[k];
    __syncwarp();
    auto* const run = reinterpret_cast<Part*>(to.data + first);
#pragma unroll
    for (int k = 0; k < parts; ++k) run[k * 32 + lane()] = place[k * 32 + lane()];
    __syncwarp();
  }

 private:
  static_assert(sizeof(Record) % 16 == 0);
  static constexpr int parts = sizeof(Record) / 16;
  struct alignas(16) Part {
    double numbers[2];
  };

  __device__ static int lane() {
    return static_cast<int>(threadIdx.x % 32);
  }
  __device__ static Part* memory() {
    __shared__ Part all[block_size * parts];
    return all + threadIdx.x / 32 * 32 * parts;
  }
  /// Parts of 16 B, `stride` parts from each to the next.
  __device__ void ask(const Record* from, int stride) {
    const auto* const first = reinterpret_cast<const double*>(from);
#pragma unroll
    for (int k = 0; k < parts; ++k)
      asm volatile("ld.global.v2.f64 {%0, %1}, [%2];"
                   : "=d"(part_[k].numbers[0]), "=d"(part_[k].numbers[1])
                   : "l"(__cvta_generic_to_global(first + 2 * k * stride)));
  }

  Part part_[parts];
  bool exchanged_ = false;
};
#else
/// On the host each lane reads and writes its own.
template <class Record>
class WarpRecords {
 public:
  BR_HD void read(const View<const Record>& from, Index i) { own_ = from[i]; }
  BR_HD Record own() const { return own_; }
  BR_HD static void write(const View<Record>& to, Index i, const Record& own) { to[i] = own; }

 private:
  Record own_{};
};
#endif

}  // namespace breccia
