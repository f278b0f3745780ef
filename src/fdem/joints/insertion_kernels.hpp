#pragma once
// Where the stress between two triangles that move as one reaches the strength of their joint.

#include "core/rows.hpp"
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

/// Stress over strength of dormant joints: tension, or shear by Mohr and Coulomb, and that of the
/// rock beside them.
struct Overshoot {
  EdgeStress stress;
  View<const JointBond> bonds;
  View<const Index> law;
  View<const double> strength;
  View<const JointStage> stage;
  View<double> overshoot;
  View<std::uint8_t> reached;
  BR_HD void set(const StepTime&) {}
  BR_HD void operator()(Index i) const {
    overshoot[i] = 0.0;
    if (stage[i] != JointStage::dormant) return;
    const RockStress s = stress(i);
    const JointBond& bond = bonds[law[i]];
    const double shear = bond.cohesion * strength[i] - bond.friction * min(s.normal, 0.0);
    overshoot[i] = max(s.normal / (bond.tension * strength[i]), abs(s.shear) / shear);
    if (bond.by_rock()) overshoot[i] = max(overshoot[i], rock_failure(bond, strength[i], s).most());
    if (overshoot[i] >= 1.0) raise(reached, Change{});
  }
};

/// Joints whose strength is reached and whose side a this rank owns.
struct IsReached {
  View<const double> overshoot;
  View<const JointEnds> ends;
  OwnedView owned;
  BR_HD bool operator()(Index i) const { return overshoot[i] >= 1.0 && owned(ends[i].a0 / 3); }
};

/// A joint whose strength is reached, and its two vertices.
struct Candidate {
  double overshoot;
  Index joint, first, second;
};
struct ListCandidates {
  static constexpr const char* name = "fdem.list_candidates";
  View<const Index> joint;
  View<const double> overshoot;
  View<const JointEnds> ends;
  View<const Index> vertex_of;  ///< of each node
  View<Candidate> candidate;
  BR_HD void operator()(Index k) const {
    const Index i = joint[k];
    candidate[k] = {overshoot[i], i, vertex_of[ends[i].a0], vertex_of[ends[i].a1]};
  }
};

/// A few of the vertices, ascending.
struct SomeVertices {
  View<const Index> vertex_of;  ///< of each node
  View<const Index> some;
  /// Whether it is the vertex of a node.
  BR_HD bool hold(Index node) const {
    const Index vertex = vertex_of[node];
    const Index place = lower_bound(some.data, 0, some.size, vertex);
    return place < some.size && some[place] == vertex;
  }
};

/// Dormant joints with one of some vertices.
struct SleepsAt {
  View<const JointStage> stage;
  View<const JointEnds> ends;
  SomeVertices parted;
  BR_HD bool operator()(Index i) const {
    return stage[i] == JointStage::dormant && (parted.hold(ends[i].a0) || parted.hold(ends[i].a1));
  }
};

/// Wakes joints at the opening and slip at which they carry what was transmitted.
struct Wake {
  static constexpr const char* name = "fdem.wake";
  EdgeStress stress;
  View<const JointBond> bonds;
  View<const Index> law;
  View<const double> strength, length, overshoot;
  View<const Index> vertex_of;
  OwnedView owned;
  View<const Index> joint;
  View<JointStage> stage;
  View<Vec2> preset;
  View<double> held;              ///< what each then stores, if this rank owns its side a  [J/m]
  View<Index> triangles, vertex;  ///< two of each

  BR_HD void operator()(Index k) const {
    const Index i = joint[k];
    const JointBond& bond = bonds[law[i]];
    const JointEnds& e = stress.ends[i];
    // just below its strength, where that is reached
    const double share = min(1.0, (1.0 - 1e-6) / overshoot[i]);
    const RockStress s = stress(i);
    Vec2 opening{};
    preset_opening(bond, strength[i], length[i], share * s.normal, share * s.shear, opening);
    preset[i] += opening;  // it held how far its triangles were moved apart at the start, if at all
    stage[i] = JointStage::whole;
    const StoredEnergy stored =
        stored_in(bond, strength[i], length[i], opening, JointOpening<double>{}, JointPoints{});
    held[k] = owned(e.a0 / 3) ? stored.open + stored.slide : 0.0;
    triangles[2 * k] = e.a0 / 3;
    triangles[2 * k + 1] = e.b0 / 3;
    vertex[2 * k] = vertex_of[e.a0];
    vertex[2 * k + 1] = vertex_of[e.a1];
  }
};

/// Who moves with whom around a vertex: corners joined by edges that are bonded or sleep.
struct TieCorners {
  static constexpr const char* name = "fdem.tie_corners";
  View<const Index> starts, nodes, across;
  View<const EdgeJoints> edges;
  View<const JointStage> stage;
  bool all;              ///< vertices; otherwise only
  SomeVertices changed;  ///< these
  View<Index> leader;

  BR_HD void operator()(Index vertex) const {
    const Index begin = starts[vertex], end = starts[vertex + 1];
    if (!all && !changed.hold(nodes[begin])) return;
    for (Index k = begin; k < end; ++k) leader[k] = k;
    for (Index k = begin; k < end; ++k) {
      // The edge that leaves this corner: across it the same vertex ends the neighbour's edge.
      const Index edge = nodes[k];
      if (!ties(edge)) continue;
      const Index other = JointEnds::next_corner(across[edge]);
      const Index a = first_of(k), b = first_of(lower_bound(nodes.data, begin, end, other));
      leader[a < b ? b : a] = a < b ? a : b;
    }
    for (Index k = begin; k < end; ++k) leader[k] = first_of(k);
  }

 private:
  BR_HD bool ties(Index edge) const {
    const Index entry = edges[edge / 3].at[edge % 3];
    return entry == edge_bonded || (entry >= 0 && stage[pair_of(entry)] == JointStage::dormant);
  }
  BR_HD Index first_of(Index k) const {
    while (leader[k] != k) k = leader[k];
    return k;
  }
};

inline TriangleStress stress_kernel(World& w) {
  const Triangles& t = w.triangles;
  return {t.nodes.view(), laws_of(w), w.given->laws.view(), t.shape_inverse.view(),
          w.stress.view()};
}
inline Overshoot overshoot_kernel(World& w) {
  const Triangles& t = w.triangles;
  return {{by_number(t.nodes.view()), w.joint_ends.view(), std::as_const(w.stress).view()},
          w.given->bonds.view(),
          w.joints.law.view(),
          w.joints.strength.view(),
          std::as_const(w.joints.stage).view(),
          w.overshoot.view(),
          w.reached.view()};
}

}  // namespace breccia::fdem
