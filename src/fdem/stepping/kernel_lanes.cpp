#include "fdem/stepping/kernel_lanes.hpp"

#include "core/add_energies.hpp"
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

#if defined(BR_WIDE_LANES)
/// Joints that packs of neighbours have left wait until those that are alike fill a pack.
template <class Number>
class LeftOver {
 public:
  LeftOver(Lanes lanes, const JointForces<Number>& joints) : lanes_(lanes), joints_(joints) {}

  void take(Index i) {
    const bool whole = joints_.stage[i] == JointStage::whole;
    if (!whole && joints_.stage[i] != JointStage::softened) return joints_.slow(i);
    Failure how = Failure::none;
    if (!whole) {
      const JointPoints& points = joints_.points[i];
      how = failure_of(points.point[0]);
      for (int q = 1; q < 3; ++q)
        if (failure_of(points.point[q]) != how) return joints_.slow(i);
    }
    // It may ask for the stress at the start, which differs from place to place.
    if (how == Failure::none && joints_.graded.size > 0) return joints_.slow(i);
    AlikeJoints& pack = packs_[whole ? 3 : static_cast<int>(how)];
    pack.whole = whole;
    pack.how = how;
    pack.joint[pack.count++] = i;
    if (pack.count == width()) run(pack);
  }
  /// Joints that still wait.
  void finish() {
    for (AlikeJoints& pack : packs_) {
      if (pack.count == 0) continue;
      for (Index k = pack.count; k < width(); ++k) pack.joint[k] = pack.joint[0];
      run(pack);
    }
  }

 private:
  Index width() const { return static_cast<Index>(lanes_); }
  void run(AlikeJoints& pack) {
    const Index count = pack.count;
    unsigned left = (1U << count) - 1U;
    if (count > 1)
      left =
          lanes_ == Lanes::eight ? PacksAvx512::run(joints_, pack) : PacksAvx2::run(joints_, pack);
    pack.count = 0;
    for (Index k = 0; k < count; ++k)
      if ((left >> k & 1U) != 0) joints_.slow(pack.joint[k]);
  }

  Lanes lanes_;
  const JointForces<Number>& joints_;
  AlikeJoints packs_[4];  ///< by Failure; whole ones
};
#endif

template <class Number>
void run_joints([[maybe_unused]] Lanes lanes, const JointForces<Number>& joints, Index begin,
                Index end) {
#if defined(BR_WIDE_LANES)
  LeftOver<Number> others(lanes, joints);
  const Index width = pack_width<JointForces<Number>>(lanes);
  while (width > 1 && end - begin >= width) {
    const LeftJoints left = lanes == Lanes::eight ? PacksAvx512::run(joints, begin, end, true)
                                                  : PacksAvx2::run(joints, begin, end, true);
    begin = left.first;
    if (left.others == 0) break;
    for (Index k = 0; k < width; ++k)
      if ((left.others >> k & 1U) != 0) others.take(begin + k);
    begin += width;
  }
  others.finish();
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
void run_packs(Lanes lanes, const JointForces<Single>& kernel, Index begin, Index end) {
  run_joints(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const TriangleForces<double>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const TriangleForces<float>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const TriangleForces<Single>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const CoupleForces<double>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const CoupleForces<float>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
bool run_packs(Lanes lanes, const MoveTriangles& kernel, Index begin, Index end) {
  return fdem_shared::move_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
bool run_packs(Lanes lanes, const SumAndMove<double>& kernel, Index begin, Index end) {
  return fdem_shared::move_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
bool run_packs(Lanes lanes, const SumAndMove<float>& kernel, Index begin, Index end) {
  return fdem_shared::move_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
bool run_packs(Lanes lanes, const SumAndMove<Single>& kernel, Index begin, Index end) {
  return fdem_shared::move_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}

Index run_whole(Lanes lanes, const JointForces<double>& kernel, Index begin, Index end) {
  return while_whole(lanes, kernel, begin, end);
}
Index run_whole(Lanes lanes, const JointForces<float>& kernel, Index begin, Index end) {
  return while_whole(lanes, kernel, begin, end);
}
Index run_whole(Lanes lanes, const JointForces<Single>& kernel, Index begin, Index end) {
  return while_whole(lanes, kernel, begin, end);
}

void add_energies(Lanes lanes, const TriangleShares& kernel, Index begin, Index end,
                  Energies& sum) {
  add_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end, sum);
}
Index StoredByJoints::add_whole([[maybe_unused]] ExactSum& elastic,
                                [[maybe_unused]] const View<const JointStage>& stage,
                                [[maybe_unused]] const View<const JointWork>& work, Index begin,
                                [[maybe_unused]] Index end) const {
#if defined(BR_WIDE_LANES)
  const WholeJoints joints{*this, stage, work};
  if (lanes == Lanes::eight) return PacksAvx512::add(joints, begin, end, elastic);
  if (lanes == Lanes::four) return PacksAvx2::add(joints, begin, end, elastic);
#endif
  return begin;
}

}  // namespace breccia::fdem
