#pragma once
// The kernels of a step with the arrays of a world: the same for loops on the host and for launches
// ahead on a device.

#include "fdem3/joints/joint_kernels.hpp"
#include "fdem3/world.hpp"

namespace breccia::fdem3 {

inline JointForces joint_kernel(World& w) {
  Joints& j = w.joints;
  return {w.time,
          w.last_dt,
          std::as_const(w.tetrahedra.nodes).view(),
          w.given->bonds.view(),
          std::as_const(j.face_a).view(),
          std::as_const(j.face_b).view(),
          std::as_const(j.turn).view(),
          std::as_const(j.law).view(),
          std::as_const(j.shape).view(),
          std::as_const(j.length).view(),
          std::as_const(j.strength).view(),
          std::as_const(j.preset).view(),
          w.given->in_situ.stress(),
          w.given->in_situ.graded() ? w.given->laws.view() : View<const ElasticTetrahedron>{},
          w.tetrahedra.id.view(),
          j.stage.view(),
          j.force.view(),
          j.work.view(),
          j.failure.view(),
          w.exposed.changed.view()};
}

inline CoupleForces couple_kernel(World& w) {
  Couples& c = w.couples;
  Joints& j = w.joints;
  return {w.last_dt,
          std::as_const(w.tetrahedra.nodes).view(),
          std::as_const(w.tetrahedra.material).view(),
          w.given->contact_pairs.view(),
          w.given->materials,
          std::as_const(w.tetrahedra.exposed).view(),
          std::as_const(c.pairs.a).view(),
          std::as_const(c.pairs.b).view(),
          std::as_const(w.parent_joint).view(),
          j.failure.view(),
          c.history.state.view(),
          c.history.force.view(),
          w.couple_phase.view()};
}

template <bool bedded>
ElementForcesOf<bedded> element_kernel(World& w) {
  Tetrahedra& t = w.tetrahedra;
  return {w.last_dt,
          std::as_const(t.nodes).view(),
          laws_of(w),
          w.given->laws.view(),
          std::as_const(t.shape).view(),
          std::as_const(t.viscosity).view(),
          std::as_const(w.faces).view(),
          std::as_const(w.joints.turn).view(),
          std::as_const(w.joints.force).view(),
          w.couple_incidence.view(),
          std::as_const(w.couples.history.force).view(),
          t.force.view(),
          t.viscous_work.view()};
}

/// Calls visit(kernel) with the kernel of the sums of forces.
template <class Visit>
void with_sums(World& w, const Visit& visit) {
  if (w.given->bedded)
    visit(element_kernel<true>(w));
  else
    visit(element_kernel<false>(w));
}

inline LoadForces load_kernel(World& w) {
  Tetrahedra& t = w.tetrahedra;
  return {std::as_const(w.load_starts).view(),
          std::as_const(w.loaded_faces).view(),
          std::as_const(w.load_laws).view(),
          std::as_const(t.nodes).view(),
          t.external.view(),
          t.force.view()};
}

inline BundleForces bundle_kernel(World& w) {
  return {w.bundles.starts.view(), w.bundles.nodes.view(), w.bundles.leader.view(),
          std::as_const(w.tetrahedra.mass).view(), w.tetrahedra.force.view()};
}

}  // namespace breccia::fdem3
