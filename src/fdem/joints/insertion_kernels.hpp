#pragma once
// Where the stress between two triangles that move as one reaches the strength of their joint.

#include "core/kernel.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {

struct TriangleStress {
  View<const TriangleNodes> nodes;
  View<const Index> material;
  View<const ElasticTriangle> laws;
  View<const Mat2> shape_inverse;
  View<Sym2> stress;
  BR_HD void set(const StepTime&) {}
  BR_HD void operator()(Index t) const {
    double numbers[12];
    gather_records(nodes, Indices<double>{t}, numbers);
    const CornersOf<double> c(numbers);
    stress[t] = laws[material[t]].stress(deformation(shape_inverse[t], c.x, c.v), 0.0);
  }
};

/// Stress at an edge: the mean of its two triangles'.
struct EdgeStress {
  View<const NodeState> nodes;
  View<const JointEnds> ends;
  View<const Sym2> stress;

  /// @returns across and in the edge as the law of the joint counts them, and along it
  BR_HD RockStress operator()(Index i) const {
    const JointEnds& e = ends[i];
    const Vec2 line = nodes[e.a1].position - nodes[e.a0].position;
    const Vec2 along = (1.0 / norm(line)) * line, across{-along.y, along.x};
    const Sym2 &a = stress[e.a0 / 3], &b = stress[e.b0 / 3];
    const Sym2 mean{0.5 * (a.xx + b.xx), 0.5 * (a.yy + b.yy), 0.5 * (a.xy + b.xy)};
    const Vec2 traction = mean * across;
    return {dot(traction, across), dot(traction, along), dot(mean * along, along)};
  }
};

/// Dormant joints: the stress over the strength of each, and its waking.
struct Sleeper {
  EdgeStress stress;
  View<const JointBond> bonds;
  View<const Index> law;
  View<const double> strength, length;
  View<JointStage> stage;
  View<Vec2> preset;

  BR_HD bool sleeps(Index i) const { return stage[i] == JointStage::dormant; }
  /// Stress over strength: tension, or shear by Mohr and Coulomb, and that of the rock beside it.
  BR_HD double overshoot(Index i) const {
    const RockStress s = stress(i);
    const JointBond& bond = bonds[law[i]];
    const double shear = bond.cohesion * strength[i] - bond.friction * min(s.normal, 0.0);
    const double most = max(s.normal / (bond.tension * strength[i]), abs(s.shear) / shear);
    return bond.by_rock() ? max(most, rock_failure(bond, strength[i], s).most()) : most;
  }
  /// @returns what it stores then  [J/m]
  BR_HD double wake(Index i, double share) const {
    const JointBond& bond = bonds[law[i]];
    const RockStress s = stress(i);
    Vec2 opening{};
    preset_opening(bond, strength[i], length[i], share * s.normal, share * s.shear, opening);
    preset[i] += opening;  // it held how far its triangles were moved apart at the start, if at all
    stage[i] = JointStage::whole;
    const StoredEnergy stored =
        stored_in(bond, strength[i], length[i], opening, JointOpening<double>{}, JointPoints{});
    return stored.open + stored.slide;
  }
};

inline TriangleStress stress_kernel(World& w) {
  const Triangles& t = w.triangles;
  return {t.nodes.view(), laws_of(w), w.given->laws.view(), t.shape_inverse.view(),
          w.stress.view()};
}
inline Sleeper sleeper_of(World& w) {
  return {
      {by_number(w.triangles.nodes.view()), w.joint_ends.view(), std::as_const(w.stress).view()},
      w.given->bonds.view(),
      w.joints.law.view(),
      w.joints.strength.view(),
      w.joints.length.view(),
      w.joints.stage.view(),
      w.joints.preset.view()};
}

}  // namespace breccia::fdem
