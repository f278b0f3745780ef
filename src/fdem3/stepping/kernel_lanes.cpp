#include "fdem3/stepping/kernel_lanes.hpp"

#include "exec/whole_packs.hpp"
#include "fdem_shared/noting_move.hpp"

namespace breccia::fdem3 {
void run_packs([[maybe_unused]] Lanes lanes, const JointForces& kernel, Index begin, Index end) {
#if defined(BR_WIDE_LANES)
  for (const auto width = static_cast<Index>(lanes); width > 1 && end - begin >= width;) {
    const auto [first, left] = lanes == Lanes::eight ? PacksAvx512::run(kernel, begin, end)
                                                     : PacksAvx2::run(kernel, begin, end);
    begin = first;
    if ((left.others | left.drags) == 0) break;
    for (Index k = 0; k < width; ++k) {
      if ((left.others >> k & 1U) != 0) kernel(begin + k);
      if ((left.drags >> k & 1U) != 0) kernel.book_slip(begin + k);
    }
    begin += width;
  }
#endif
  for (; begin < end; ++begin) kernel(begin);
}
void run_packs(Lanes lanes, const ElementForces& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const BeddedForces& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
bool run_packs(Lanes lanes, const MoveTetrahedra& kernel, Index begin, Index end) {
  return fdem_shared::move_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}

}  // namespace breccia::fdem3
