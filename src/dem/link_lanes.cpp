#include "dem/link_lanes.hpp"

namespace breccia::dem {

void run_links([[maybe_unused]] Lanes lanes, const ConcreteLinkForces& kernel, Index begin,
               Index end) {
#if defined(BR_WIDE_LANES)
  // One by one to where packs lie in whole cache lines.
  for (; begin < end && begin % static_cast<Index>(lanes) != 0; ++begin) kernel(begin);
  if (lanes == Lanes::eight) begin = run_links_avx512(kernel, begin, end);
  if (lanes == Lanes::four) begin = run_links_avx2(kernel, begin, end);
#endif
  for (Index i = begin; i < end; ++i) kernel(i);
}

}  // namespace breccia::dem
