#pragma once
// Where the stress between two triangles that move as one reaches the strength of their joint.

#include "fdem/world.hpp"

namespace breccia::fdem {

struct TriangleStress {
  View<const TriangleNodes> nodes;
  View<const Index> material;
  View<const ElasticTriangle> laws;
  View<const Mat2> shape_inverse;
  View<Sym2> stress;
  BR_HD void set(const Moment&) {}
  BR_HD void operator()(Index t) const {
    const CornersOf<double> c(nodes, t);
    stress[t] = laws[material[t]].stress(deformation(shape_inverse[t], c.x, c.v), 0.0);
  }
};

/// Traction across an edge from the mean stress of its two triangles.
struct EdgeTraction {
  View<const NodeState> nodes;
  View<const JointEnds> ends;
  View<const Sym2> stress;

  /// @returns normal and shear, as the law of the joint counts them  [Pa]
  BR_HD Vec2 operator()(Index i) const {
    const JointEnds& e = ends[i];
    const Vec2 line = nodes[e.a1].position - nodes[e.a0].position;
    const Vec2 along = (1.0 / norm(line)) * line, across{-along.y, along.x};
    const Sym2 &a = stress[e.a0 / 3], &b = stress[e.b0 / 3];
    const Sym2 mean{0.5 * (a.xx + b.xx), 0.5 * (a.yy + b.yy), 0.5 * (a.xy + b.xy)};
    const Vec2 traction = mean * across;
    return {dot(traction, across), dot(traction, along)};
  }
};

/// Stress over strength of dormant joints: tension, or shear by Mohr and Coulomb.
struct Overshoot {
  EdgeTraction traction;
  View<const JointBond> bonds;
  View<const Index> law;
  View<const double> strength;
  View<const JointStage> stage;
  View<double> overshoot;
  View<std::uint8_t> reached;
  BR_HD void set(const Moment&) {}
  BR_HD void operator()(Index i) const {
    overshoot[i] = 0.0;
    if (stage[i] != JointStage::dormant) return;
    const Vec2 t = traction(i);
    const JointBond& bond = bonds[law[i]];
    const double shear = bond.cohesion * strength[i] - bond.friction * smaller(t.x, 0.0);
    overshoot[i] = larger(t.x / (bond.tension * strength[i]), absolute(t.y) / shear);
    if (overshoot[i] >= 1.0) raise(reached, Change{});
  }
};

inline TriangleStress stress_kernel(World& w) {
  const Triangles& t = w.triangles;
  return {t.nodes.view(), t.material.view(), w.laws.view(), t.shape_inverse.view(),
          w.stress.view()};
}
inline Overshoot overshoot_kernel(World& w) {
  const Triangles& t = w.triangles;
  return {{by_number(t.nodes.view()), w.joint_ends.view(), std::as_const(w.stress).view()},
          w.bonds.view(),
          w.joints.law.view(),
          w.joints.strength.view(),
          std::as_const(w.joints.stage).view(),
          w.overshoot.view(),
          w.reached.view()};
}

}  // namespace breccia::fdem
