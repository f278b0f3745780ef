#pragma once
// How far joints are open, for probes and frames.

#include "fdem/joints/joints.hpp"
#include "fdem/triangles/triangles.hpp"
#include "fdem_shared/motion.hpp"

namespace breccia::fdem {

/// Joints: opening and slip in the middle.
struct JointsToRead {
  View<const TriangleNodes> nodes;
  View<const Index> side_a, side_b;

  BR_HD Vec3 middle(Index i) const {
    const JointEnds e = ends(i);
    return fdem_shared::to_space(0.25 *
                                 (corner(e.a0) + corner(e.a1) + corner(e.b0) + corner(e.b1)));
  }
  BR_HD double opening(Index i) const { return open(i).open[1]; }
  BR_HD double slip(Index i) const { return abs(open(i).slide[1]); }

 private:
  BR_HD JointEnds ends(Index i) const { return JointEnds::of(side_a[i], side_b[i]); }
  BR_HD Vec2 corner(Index n) const { return nodes[n / 3].at[n % 3].position; }
  BR_HD JointOpening<double> open(Index i) const {
    const JointEnds e = ends(i);
    return opening_of(corner(e.a0), corner(e.a1), corner(e.b0), corner(e.b1));
  }
};

}  // namespace breccia::fdem
