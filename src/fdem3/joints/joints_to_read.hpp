#pragma once
// How far joints are open, for probes and frames.

#include "fdem3/elements/tetrahedra.hpp"
#include "fdem3/joints/joints.hpp"

namespace breccia::fdem3 {

/// Joints: mean opening and slip.
struct JointsToRead {
  View<const TetrahedronNodes> nodes;
  View<const Index> side_a, side_b;
  View<const std::uint8_t> turn;

  BR_HD Vec3 middle(Index i) const {
    Vec3 a[3], b[3], middle{};
    corners(i, a, b);
    for (int k = 0; k < 3; ++k) middle += (1.0 / 6.0) * (a[k] + b[k]);
    return middle;
  }
  BR_HD double opening(Index i) const {
    const JointOpening o = open(i);
    return (o.open[0] + o.open[1] + o.open[2]) / 3.0;
  }
  BR_HD double slip(Index i) const {
    const JointOpening o = open(i);
    return norm((1.0 / 3.0) * (o.slide[0] + o.slide[1] + o.slide[2]));
  }

 private:
  BR_HD void corners(Index i, Vec3 (&a)[3], Vec3 (&b)[3]) const {
    const JointEnds e = JointEnds::of(side_a[i], side_b[i], turn[i]);
    for (int k = 0; k < 3; ++k) {
      a[k] = nodes[e.a[k] / 4].at[e.a[k] % 4].position;
      b[k] = nodes[e.b[k] / 4].at[e.b[k] % 4].position;
    }
  }
  BR_HD JointOpening open(Index i) const {
    Vec3 a[3], b[3];
    corners(i, a, b);
    return opening_of(a, b);
  }
};

}  // namespace breccia::fdem3
