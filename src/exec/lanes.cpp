#include "exec/lanes.hpp"

namespace breccia {

Lanes widest_lanes() {
#if defined(BR_WIDE_LANES)
  if (__builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
      __builtin_cpu_supports("avx512vl") != 0)
    return Lanes::eight;
  if (__builtin_cpu_supports("avx2") != 0) return Lanes::four;
#endif
  return Lanes::one;
}

}  // namespace breccia
