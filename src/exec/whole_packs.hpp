#pragma once
// Packs where they can be taken whole, all else one by one.

#include "exec/lanes.hpp"
#include "exec/types.hpp"

namespace breccia {

/// kernel for the items [begin, end). A wide build stops where a pack is not as most are; that pack
/// is taken one by one, by code that runs on every processor.
/// @tparam Eight, Four  builds for AVX-512 and AVX2; their run() returns where it stops
template <class Eight, class Four, class Kernel>
void run_whole_packs([[maybe_unused]] Lanes lanes, const Kernel& kernel, Index begin, Index end) {
#if defined(BR_WIDE_LANES)
  for (const auto width = static_cast<Index>(lanes); width > 1 && end - begin >= width;) {
    begin = lanes == Lanes::eight ? Eight::run(kernel, begin, end) : Four::run(kernel, begin, end);
    if (end - begin < width) break;
    for (const Index next = begin + width; begin < next; ++begin) kernel(begin);
  }
#endif
  for (; begin < end; ++begin) kernel(begin);
}

}  // namespace breccia
