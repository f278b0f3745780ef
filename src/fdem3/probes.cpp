// Readings of probes: stresses of tetrahedra, cracks of joints, and what fdem_shared/readings.hpp
// reads of corners.

#include "fdem3/joints/joints_to_read.hpp"
#include "fdem3/observe.hpp"
#include "fdem_shared/readings.hpp"

namespace breccia::fdem3 {

/// Stress of tetrahedra, each by its volume.
struct StressToRead {
  View<const Index> material;
  View<const TetrahedronNodes> nodes;
  View<const ShapeGradients> shape;
  View<const ElasticTetrahedron> laws;
  View<const Index> hold;
  View<const Hold> holds;

  BR_HD bool is_gone(Index t) const { return fdem_shared::is_gone<Shape>(holds, hold[t]); }
  BR_HD Vec3 middle(Index t) const { return centroid(nodes[t]); }
  BR_HD Readings weighted(Index t, int i, int j, GlobalId id) const {
    Vec3 x[4];
    places(nodes[t], x);
    const Deformation d = deformation(shape[t], x);
    const Sym3 s = laws[material[t]].stress(d);
    return Readings::weighted(component(s, i, j), d.jacobian * shape[t].volume(), id);
  }
};
StressToRead stress_to_read(const World& w) {
  const Tetrahedra& t = w.tetrahedra;
  return {laws_of(w),           t.nodes.view(), t.shape.view(),
          w.given->laws.view(), t.hold.view(),  w.given->holds.view()};
}

JointsToRead joints_to_read(const World& w) {
  const Joints& j = w.joints;
  return {w.tetrahedra.nodes.view(), j.face_a.view(), j.face_b.view(), j.turn.view()};
}

}  // namespace breccia::fdem3

namespace breccia::fdem_shared {

template std::function<double()> probe_later(const fdem3::World&, const ProbeConfig&);
template Readings read_own(fdem3::World&, const ProbeConfig&);

}  // namespace breccia::fdem_shared
