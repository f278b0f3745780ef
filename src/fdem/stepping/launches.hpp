#pragma once
// The kernels of a step with the arrays of a world: the same for loops on the host and for launches
// ahead on a device.

#include "fdem/world.hpp"

namespace breccia::fdem {

template <class Number>
JointForces<Number> joint_kernel(World& w) {
  Joints& j = w.joints;
  return {w.time,
          w.last_dt,
          by_number(std::as_const(w.triangles.nodes).view()),
          w.given->bonds.view(),
          w.given->bonds_in_single.view(),
          w.joint_ends.view(),
          j.law.view(),
          j.length.view(),
          j.strength.view(),
          j.preset.view(),
          {w.given->in_situ.xx, w.given->in_situ.yy, w.given->in_situ.xy},
          w.given->in_situ.graded() ? w.given->laws.view() : View<const ElasticTriangle>{},
          std::as_const(w.triangles.id).view(),
          j.stage.view(),
          j.points.view(),
          j.force.as<Number>().view(),
          j.work.view(),
          j.broke_at.view(),
          j.handover.view(),
          j.rubbed.view(),
          w.exposed.changed.view()};
}

template <class Number>
CoupleForces<Number> couple_kernel(World& w) {
  Couples& c = w.couples;
  Joints& j = w.joints;
  return {w.last_dt,
          w.given->conservative,
          w.given->rebound,
          std::as_const(w.triangles.nodes).view(),
          w.triangles.material.view(),
          w.given->contact_pairs.view(),
          w.given->materials,
          c.pairs.a.view(),
          c.pairs.b.view(),
          std::as_const(w.parent_joint).view(),
          {std::as_const(j.edge_a).view(), std::as_const(j.edge_b).view(),
           std::as_const(j.handover).view(), j.inherited_work.view()},
          c.history.state.view(),
          c.history.force.as<Number>().view(),
          w.couple_phase.view()};
}

template <class Number>
TriangleForces<Number> triangle_kernel(World& w) {
  Triangles& t = w.triangles;
  return {w.last_dt,
          std::as_const(t.nodes).view(),
          laws_of(w),
          w.given->laws.view(),
          w.given->laws_in_single.view(),
          t.shape_inverse.view(),
          t.viscosity.view(),
          w.edges.view(),
          std::as_const(w.joints.force.as<Number>()).view(),
          w.couple_incidence.view(),
          std::as_const(w.couples.history.force.as<Number>()).view(),
          std::as_const(w.couple_phase).view(),
          t.force.view(),
          t.viscous_work.view()};
}

/// Calls visit(kernel) with the kernel of the sums of forces.
template <class Visit>
void with_sums(World& w, const Visit& visit) {
  with_arithmetic(w.exec.precision,
                  [&](auto number) { visit(triangle_kernel<decltype(number)>(w)); });
}

inline LoadForces load_kernel(World& w) {
  Triangles& t = w.triangles;
  return {w.load_starts.view(),          w.loaded_edges.view(), w.load_laws.view(),
          std::as_const(t.nodes).view(), t.external.view(),     t.force.view()};
}

inline BundleForces bundle_kernel(World& w) {
  return {w.bundles.starts.view(), w.bundles.nodes.view(), w.bundles.leader.view(),
          w.triangles.mass.view(), w.triangles.force.view()};
}

}  // namespace breccia::fdem
