#pragma once
// Kernels of tetrahedra over packs of items, as wide as the processor allows (exec/lanes.hpp).

#include "exec/lanes.hpp"
#include "fdem3/elements/element_kernels.hpp"
#include "fdem3/joints/joint_kernels.hpp"

namespace breccia::fdem3 {

/// kernel for the items [begin, end), in packs of so many lanes, with the bits of one by one.
void run_packs(Lanes lanes, const JointForces& kernel, Index begin, Index end);
void run_packs(Lanes lanes, const ElementForces& kernel, Index begin, Index end);
void run_packs(Lanes lanes, const BeddedForces& kernel, Index begin, Index end);
/// @returns whether a tetrahedron has used its margin up
bool run_packs(Lanes lanes, const MoveTetrahedra& kernel, Index begin, Index end);

/// Where a move stopped, and whether a tetrahedron before has used its margin up.
struct MovedTo {
  Index end;
  bool beyond;
};
/// A pack of joints, from `first` on, and what is left to do of it.
struct LeftJoints {
  Index first;
  JointForces::Left left;
};

/// Builds of lanes/kernel_lanes.cpp for one width each. Return where they stop: at what does not
/// fill a pack, or at a pack that is not as most are. Both are left to the caller, whose build runs
/// on every processor; of a pack of joints only what is left.
struct PacksAvx2 {
  static LeftJoints run(const JointForces& kernel, Index begin, Index end);
  static Index run(const ElementForces& kernel, Index begin, Index end);
  static Index run(const BeddedForces& kernel, Index begin, Index end);
  static MovedTo run(const MoveTetrahedra& kernel, Index begin, Index end);
};
struct PacksAvx512 {
  static LeftJoints run(const JointForces& kernel, Index begin, Index end);
  static Index run(const ElementForces& kernel, Index begin, Index end);
  static Index run(const BeddedForces& kernel, Index begin, Index end);
  static MovedTo run(const MoveTetrahedra& kernel, Index begin, Index end);
};

}  // namespace breccia::fdem3
