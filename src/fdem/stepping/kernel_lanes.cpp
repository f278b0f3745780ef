#include "fdem/stepping/kernel_lanes.hpp"

#include "exec/whole_packs.hpp"
#include "fdem_shared/noting_move.hpp"

namespace breccia::fdem {
namespace {

template <class Number>
Index while_whole([[maybe_unused]] Lanes lanes, const JointForces<Number>& joints, Index begin,
                  Index end) {
#if defined(BR_WIDE_LANES)
  if (lanes == Lanes::eight) begin = PacksAvx512::run(joints, begin, end, false).first;
  if (lanes == Lanes::four) begin = PacksAvx2::run(joints, begin, end, false).first;
#endif
  // A dormant one may wake yet.
  while (begin < end && joints.stage[begin] == JointStage::whole && run_at<double>(joints, begin))
    ++begin;
  return begin;
}

template <class Number>
void run_joints([[maybe_unused]] Lanes lanes, const JointForces<Number>& joints, Index begin,
                Index end) {
#if defined(BR_WIDE_LANES)
  for (const auto width = static_cast<Index>(lanes); width > 1 && end - begin >= width;) {
    const LeftJoints left = lanes == Lanes::eight ? PacksAvx512::run(joints, begin, end, true)
                                                  : PacksAvx2::run(joints, begin, end, true);
    begin = left.first;
    if (left.others == 0) break;
    for (Index k = 0; k < width; ++k)
      if ((left.others >> k & 1U) != 0) joints.slow(begin + k);
    begin += width;
  }
#endif
  for (; begin < end; ++begin) joints(begin);
}

}  // namespace

void run_packs(Lanes lanes, const JointForces<double>& kernel, Index begin, Index end) {
  run_joints(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const JointForces<float>& kernel, Index begin, Index end) {
  run_joints(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const TriangleForces<double>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const TriangleForces<float>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const CoupleForces<double>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const CoupleForces<float>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
bool run_packs(Lanes lanes, const MoveTriangles& kernel, Index begin, Index end) {
  bool beyond = false;
  run_whole_packs<fdem_shared::NotingPacks<PacksAvx512>, fdem_shared::NotingPacks<PacksAvx2>>(
      lanes, fdem_shared::NotingMove{kernel, beyond}, begin, end);
  return beyond;
}

Index run_whole(Lanes lanes, const JointForces<double>& kernel, Index begin, Index end) {
  return while_whole(lanes, kernel, begin, end);
}
Index run_whole(Lanes lanes, const JointForces<float>& kernel, Index begin, Index end) {
  return while_whole(lanes, kernel, begin, end);
}

}  // namespace breccia::fdem
