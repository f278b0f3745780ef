#pragma once
// Sums of counts that come before each, on a device: two launches and one look, of which the host
// need not wait for the second. Only files that nvcc compiles include this header.

#include <cstring>

#include "exec/launch.hpp"
#include "exec/look.hpp"
#include "exec/sort_scan.hpp"

namespace breccia {

inline constexpr Index each_in_scan = 4, tile_of_scan = block_size * each_in_scan;

/// Sum of what the threads of a block before this one have; `total`: of all.
__device__ inline std::int64_t sum_before(std::int64_t own, std::int64_t& total) {
  constexpr int warps = block_size / 32;
  __shared__ std::int64_t of_warp[warps];
  const int lane = static_cast<int>(threadIdx.x % 32), warp = static_cast<int>(threadIdx.x / 32);
  std::int64_t up_to = own;
  for (int step = 1; step < 32; step *= 2) {
    const std::int64_t below = __shfl_up_sync(~0U, up_to, static_cast<unsigned>(step));
    if (lane >= step) up_to += below;
  }
  if (lane == 31) of_warp[warp] = up_to;
  __syncthreads();
  std::int64_t before = 0;
  total = 0;
  for (int w = 0; w < warps; ++w) {
    if (w < warp) before += of_warp[w];
    total += of_warp[w];
  }
  __syncthreads();
  return before + up_to - own;
}

/// Sums of counts tile by tile, then of the tiles before each.
/// @param of    of(i): the count of item i; called once for each
/// @param flag  a number to tell, too; may be absent
template <class Of>
__global__ void __launch_bounds__(block_size)
    sum_tiles(Index count, Of of, Look look, const Index* flag, bool tells) {
  follow_previous();
  auto* const sums = reinterpret_cast<std::int64_t*>(look.work);
  std::int64_t own = 0, total = 0;
  for (Index k = 0; k < each_in_scan; ++k) {
    const std::int64_t i = static_cast<std::int64_t>(blockIdx.x) * tile_of_scan + k * block_size +
                           static_cast<Index>(threadIdx.x);
    if (i < count) own += of(static_cast<Index>(i));
  }
  sum_before(own, total);
  if (threadIdx.x == 0) sums[blockIdx.x] = total;
  if (!is_last_block(look)) return;
  std::int64_t all = 0;
  for (unsigned first = 0; first < gridDim.x; first += block_size) {
    const unsigned tile = first + threadIdx.x;
    const std::int64_t in_tile = tile < gridDim.x ? sums[tile] : 0;
    const std::int64_t before = sum_before(in_tile, total);
    if (tile < gridDim.x) sums[tile] = all + before;
    all += total;
  }
  if (threadIdx.x == 0 && tells) tell(look, Scanned{all, flag != nullptr ? *flag : 0});
}

/// put(i, begin, n) for each item with its count n and the sum of all before it.
template <class Of, class Put>
__global__ void __launch_bounds__(block_size) put_tiles(Index count, Of of, Look look, Put put) {
  follow_previous();
  const auto* const sums = reinterpret_cast<const std::int64_t*>(look.work);
  const std::int64_t first = static_cast<std::int64_t>(blockIdx.x) * tile_of_scan +
                             static_cast<Index>(threadIdx.x) * each_in_scan;
  Index n[each_in_scan];
  std::int64_t own = 0, total = 0;
  for (Index k = 0; k < each_in_scan; ++k) {
    n[k] = first + k < count ? of(static_cast<Index>(first + k)) : 0;
    own += n[k];
  }
  std::int64_t begin = sums[blockIdx.x] + sum_before(own, total);
  for (Index k = 0; k < each_in_scan; ++k) {
    if (first + k < count) put(static_cast<Index>(first + k), static_cast<Index>(begin), n[k]);
    begin += n[k];
  }
}

/// Scans counts. @returns their sum and the flag, if they are asked for
template <class Of, class Again, class Put>
Scanned scan_on_device(Index count, const Of& of, const Again& again, const Put& put,
                       const Index* flag, bool asks) {
  if (count <= 0) return {0, 0};
  const Index tiles = (count - 1) / tile_of_scan + 1;
  const Look look = next_look(static_cast<std::size_t>(tiles) * sizeof(std::int64_t));
  launch(of, sum_tiles<Of>, tiles, block_size, count, of, look, flag, asks);
  launch(put, put_tiles<Again, Put>, tiles, block_size, count, again, look, put);
  if (!asks) return {0, 0};
  wait_for(look);
  Scanned scanned;
  std::memcpy(&scanned, look.told, sizeof scanned);
  return scanned;
}

}  // namespace breccia
