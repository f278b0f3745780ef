// Readings of probes: stresses of triangles, cracks of joints, and what fdem_shared/readings.hpp
// reads of corners.

#include "fdem/joints/joints_to_read.hpp"
#include "fdem/observe.hpp"
#include "fdem_shared/readings.hpp"

namespace breccia::fdem {

/// Stress of triangles, each by its area.
struct StressToRead {
  View<const Index> material;
  View<const TriangleNodes> nodes;
  View<const Mat2> shape_inverse;
  View<const ElasticTriangle> laws;
  View<const Index> hold;
  View<const Hold> holds;

  BR_HD bool is_gone(Index t) const { return fdem::is_gone(holds, hold[t]); }
  BR_HD Vec3 middle(Index t) const {
    const NodeState(&n)[3] = nodes[t].at;
    return fdem_shared::to_space((1.0 / 3.0) * (n[0].position + n[1].position + n[2].position));
  }
  BR_HD Readings weighted(Index t, int i, int j, GlobalId id) const {
    Vec2 x[3], v[3];
    split(nodes[t], x, v);
    const Sym2 s = laws[material[t]].stress(deformation(shape_inverse[t], x, v), 0.0);
    const double component = i != j ? s.xy : i == 0 ? s.xx : s.yy;
    return Readings::weighted(component, 0.5 * cross(x[1] - x[0], x[2] - x[0]), id);
  }
};
StressToRead stress_to_read(const World& w) {
  const Triangles& t = w.triangles;
  return {laws_of(w),           t.nodes.view(), t.shape_inverse.view(),
          w.given->laws.view(), t.hold.view(),  w.given->holds.view()};
}

JointsToRead joints_to_read(const World& w) {
  return {w.triangles.nodes.view(), w.joints.edge_a.view(), w.joints.edge_b.view()};
}

}  // namespace breccia::fdem

namespace breccia::fdem_shared {

template std::function<double()> probe_later(const fdem::World&, const ProbeConfig&);
template Readings read_own(fdem::World&, const ProbeConfig&);

}  // namespace breccia::fdem_shared
