#pragma once
// The widest form of the link kernels that this processor can run, found at run time; same bits in
// all.

#include "dem/link_kernels.hpp"

namespace breccia::dem {

/// How many links the processor takes side by side: 1, 4 (AVX2) or 8 (AVX-512).
enum class Lanes { one = 1, four = 4, eight = 8 };

/// The widest that was built and that this processor has.
Lanes widest_lanes();

/// kernel for the links [begin, end) on the calling thread.
void run_links(Lanes lanes, const ConcreteLinkForces& kernel, Index begin, Index end);

// Each is one build of link_lanes.cpp; what does not fill a pack is left to the caller. Return
// where.
Index run_links_avx2(const ConcreteLinkForces& kernel, Index begin, Index end);
Index run_links_avx512(const ConcreteLinkForces& kernel, Index begin, Index end);

}  // namespace breccia::dem
