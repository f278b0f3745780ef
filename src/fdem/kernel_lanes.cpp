#include "fdem/kernel_lanes.hpp"

namespace breccia::fdem {
namespace {

/// Packs where they can be taken whole, the others one by one.
template <class Kernel>
void run_widest([[maybe_unused]] Lanes lanes, const Kernel& kernel, Index begin, Index end) {
#if defined(BR_WIDE_LANES)
  for (const auto width = static_cast<Index>(lanes); width > 1 && end - begin >= width;) {
    begin = lanes == Lanes::eight ? PacksAvx512::run(kernel, begin, end)
                                  : PacksAvx2::run(kernel, begin, end);
    if (end - begin < width) break;
    for (const Index next = begin + width; begin < next; ++begin) kernel(begin);
  }
#endif
  for (; begin < end; ++begin) kernel(begin);
}

}  // namespace

void run_packs(Lanes lanes, const JointForces& kernel, Index begin, Index end) {
  run_widest(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const TriangleForces& kernel, Index begin, Index end) {
  run_widest(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const MoveTriangles& kernel, Index begin, Index end) {
  run_widest(lanes, kernel, begin, end);
}

}  // namespace breccia::fdem
