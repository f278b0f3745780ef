#pragma once
// The widest form of the link kernels that this processor can run, found at run time; same bits in
// all.

#include "dem/link_kernels.hpp"
#include "exec/lanes.hpp"

namespace breccia::dem {

/// kernel for the links [begin, end) on the calling thread.
void run_links(Lanes lanes, const ConcreteLinkForces& kernel, Index begin, Index end);

// Each is one build of link_lanes.cpp; what does not fill a pack is left to the caller. Return
// where.
Index run_links_avx2(const ConcreteLinkForces& kernel, Index begin, Index end);
Index run_links_avx512(const ConcreteLinkForces& kernel, Index begin, Index end);

}  // namespace breccia::dem
