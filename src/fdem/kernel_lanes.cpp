#include "fdem/kernel_lanes.hpp"

namespace breccia::fdem {
namespace {

template <class Kernel>
void run_widest([[maybe_unused]] Lanes lanes, const Kernel& kernel, Index begin, Index end) {
#if defined(BR_WIDE_LANES)
  if (lanes == Lanes::eight) begin = PacksAvx512::run(kernel, begin, end);
  if (lanes == Lanes::four) begin = PacksAvx2::run(kernel, begin, end);
#endif
  for (Index i = begin; i < end; ++i) kernel(i);
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
