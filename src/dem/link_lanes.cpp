#include "dem/link_lanes.hpp"

namespace breccia::dem {

Lanes widest_lanes() {
#if defined(BR_WIDE_LANES)
  if (__builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
      __builtin_cpu_supports("avx512vl") != 0)
    return Lanes::eight;
  if (__builtin_cpu_supports("avx2") != 0) return Lanes::four;
#endif
  return Lanes::one;
}

void run_links([[maybe_unused]] Lanes lanes, const ConcreteLinkForces& kernel, Index begin,
               Index end) {
#if defined(BR_WIDE_LANES)
  if (lanes == Lanes::eight) begin = run_links_avx512(kernel, begin, end);
  if (lanes == Lanes::four) begin = run_links_avx2(kernel, begin, end);
#endif
  for (Index i = begin; i < end; ++i) kernel(i);
}

}  // namespace breccia::dem
