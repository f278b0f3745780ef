#pragma once
// The widest form of the kernels that this processor can run, found at run time; same bits in all.

#include "exec/lanes.hpp"
#include "fdem/contact/couples.hpp"
#include "fdem/joints/joint_energies.hpp"
#include "fdem/joints/joint_lanes.hpp"
#include "fdem/triangles/triangle_energies.hpp"
#include "fdem/triangles/triangle_kernels.hpp"
#include "fdem_shared/sum_and_move.hpp"

namespace breccia::fdem {

template <class Number>
using SumAndMove = fdem_shared::SumAndMove<TriangleForces<Number>, MoveTriangles>;

/// Items of a whole pack.
template <class Kernel>
Index pack_width(Lanes lanes) {
  return static_cast<Index>(lanes) * (Kernel::in_single && lanes != Lanes::one ? 2 : 1);
}
/// kernel for the items [begin, end) on the calling thread.
void run_packs(Lanes lanes, const JointForces<double>& kernel, Index begin, Index end);
void run_packs(Lanes lanes, const JointForces<float>& kernel, Index begin, Index end);
void run_packs(Lanes lanes, const JointForces<Single>& kernel, Index begin, Index end);
void run_packs(Lanes lanes, const TriangleForces<double>& kernel, Index begin, Index end);
void run_packs(Lanes lanes, const TriangleForces<float>& kernel, Index begin, Index end);
void run_packs(Lanes lanes, const TriangleForces<Single>& kernel, Index begin, Index end);
void run_packs(Lanes lanes, const CoupleForces<double>& kernel, Index begin, Index end);
void run_packs(Lanes lanes, const CoupleForces<float>& kernel, Index begin, Index end);
/// @returns whether a triangle has used its margin up
bool run_packs(Lanes lanes, const MoveTriangles& kernel, Index begin, Index end);
bool run_packs(Lanes lanes, const SumAndMove<double>& kernel, Index begin, Index end);
bool run_packs(Lanes lanes, const SumAndMove<float>& kernel, Index begin, Index end);
bool run_packs(Lanes lanes, const SumAndMove<Single>& kernel, Index begin, Index end);

/// Where a move stopped, and whether a triangle before has used its margin up.
struct MovedTo {
  Index end;
  bool beyond;
};

/// A pack of joints, from `first` on, and those of it that are left to slow(), a bit for each.
struct LeftJoints {
  Index first;
  unsigned others;
};

/// Joints from `begin` on as long as they are whole, stay so and book no slip. @returns where that
/// ends; from there on nothing is written, but forces of joints that are whole and stay so
Index run_whole(Lanes lanes, const JointForces<double>& kernel, Index begin, Index end);
Index run_whole(Lanes lanes, const JointForces<float>& kernel, Index begin, Index end);
Index run_whole(Lanes lanes, const JointForces<Single>& kernel, Index begin, Index end);

/// Builds of lanes/kernel_lanes.cpp for one width each. Return where they stop: at what does not
/// fill a pack, or at a pack that is not as most are. Both are left to the caller, whose build runs
/// on every processor; of a pack of joints only the others. Without `books` they stop at joints
/// that slip under pressure, too: the length of the step is not known yet.
/// Joints that are alike by packs of their own: run_alike().
struct PacksAvx2 {
  static LeftJoints run(const JointForces<double>& kernel, Index begin, Index end, bool books);
  static LeftJoints run(const JointForces<float>& kernel, Index begin, Index end, bool books);
  static LeftJoints run(const JointForces<Single>& kernel, Index begin, Index end, bool books);
  static unsigned run(const JointForces<double>& kernel, const AlikeJoints& pack);
  static unsigned run(const JointForces<float>& kernel, const AlikeJoints& pack);
  static unsigned run(const JointForces<Single>& kernel, const AlikeJoints& pack);
  static Index run(const TriangleForces<double>& kernel, Index begin, Index end);
  static Index run(const TriangleForces<float>& kernel, Index begin, Index end);
  static Index run(const TriangleForces<Single>& kernel, Index begin, Index end);
  static Index run(const CoupleForces<double>& kernel, Index begin, Index end);
  static Index run(const CoupleForces<float>& kernel, Index begin, Index end);
  static MovedTo run(const MoveTriangles& kernel, Index begin, Index end);
  static MovedTo run(const SumAndMove<double>& kernel, Index begin, Index end);
  static MovedTo run(const SumAndMove<float>& kernel, Index begin, Index end);
  static MovedTo run(const SumAndMove<Single>& kernel, Index begin, Index end);
  static Index add(const TriangleShares& kernel, Index begin, Index end, Energies& sum);
  static Index add(const WholeJoints& joints, Index begin, Index end, ExactSum& elastic);
};
struct PacksAvx512 {
  static LeftJoints run(const JointForces<double>& kernel, Index begin, Index end, bool books);
  static LeftJoints run(const JointForces<float>& kernel, Index begin, Index end, bool books);
  static LeftJoints run(const JointForces<Single>& kernel, Index begin, Index end, bool books);
  static unsigned run(const JointForces<double>& kernel, const AlikeJoints& pack);
  static unsigned run(const JointForces<float>& kernel, const AlikeJoints& pack);
  static unsigned run(const JointForces<Single>& kernel, const AlikeJoints& pack);
  static Index run(const TriangleForces<double>& kernel, Index begin, Index end);
  static Index run(const TriangleForces<float>& kernel, Index begin, Index end);
  static Index run(const TriangleForces<Single>& kernel, Index begin, Index end);
  static Index run(const CoupleForces<double>& kernel, Index begin, Index end);
  static Index run(const CoupleForces<float>& kernel, Index begin, Index end);
  static MovedTo run(const MoveTriangles& kernel, Index begin, Index end);
  static MovedTo run(const SumAndMove<double>& kernel, Index begin, Index end);
  static MovedTo run(const SumAndMove<float>& kernel, Index begin, Index end);
  static MovedTo run(const SumAndMove<Single>& kernel, Index begin, Index end);
  static Index add(const TriangleShares& kernel, Index begin, Index end, Energies& sum);
  static Index add(const WholeJoints& joints, Index begin, Index end, ExactSum& elastic);
};

}  // namespace breccia::fdem
