#pragma once
// Kernels of the search of couples: tetrahedra that can touch, and pairs of them.

#include "core/energy.hpp"
#include "domain/drift.hpp"
#include "fdem/contact/search_kernels.hpp"
#include "fdem3/world.hpp"

namespace breccia::fdem3 {

using fdem::OpenVertices;

/// Marks the vertices of damaged joints.
struct MarkDamaged {
  static constexpr const char* name = "fdem3.mark_damaged";
  View<const JointStage> stage;
  View<const Index> face_a, vertex_of;
  View<std::uint8_t> marked;
  BR_HD void operator()(Index i) const {
    if (!is_damaged(stage[i])) return;
    for (int k = 0; k < 3; ++k)
      fdem::set_flag(marked, vertex_of[4 * (face_a[i] / 4) + corner_of_face(face_a[i] % 4, k)]);
  }
};

/// Tetrahedra with a corner at the border, at a face that nothing joins, or at a damaged joint.
struct Touchable {
  OpenVertices vertices;
  BR_HD bool operator()(Index t) const {
    int open = 0;
    for (Index k = 0; k < 4; ++k) open |= vertices.open(vertices.vertex_of[4 * t + k]);
    return open != 0;
  }
};

/// Starts the travel of a tetrahedron anew and boxes it with its margin and what counts as near.
struct BeginReach {
  double skin, horizon, largest;  ///<  [m], [s], [m]
  Drift drift;
  View<const Index> tetrahedron;
  View<const TetrahedronNodes> nodes;
  View<const ShapeGradients> shape;
  View<const GlobalId> id_of;
  View<Corners> reference;
  View<double> margin;
  View<Box> boxes;
  View<GlobalId> ids;
  BR_HD void operator()(Index i) const {
    const Index t = tetrahedron[i];
    const TetrahedronNodes& now = nodes[t];
    double fastest = 0.0, extent = 0.0;
    Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (int k = 0; k < 4; ++k) {
      const Vec3& x = now.at[k].position;
      fastest = max(fastest, norm(now.at[k].velocity - drift.velocity));
      extent = max(extent, max(abs(x.x), max(abs(x.y), abs(x.z))));
      reference[i].at[k] = x;
      low = {min(low.x, x.x), min(low.y, x.y), min(low.z, x.z)};
      high = {max(high.x, x.x), max(high.y, x.y), max(high.z, x.z)};
    }
    const double own = min(0.5 * skin + fastest * horizon, largest);
    // covers rounding
    const double grown =
        (own + near_reach(shape[t])) * (1.0 + 1e-12) + 1e-15 * (extent + drift.farthest);
    const Vec3 by{grown, grown, grown};
    margin[i] = own;
    boxes[i] = {low - by, high + by};
    ids[i] = id_of[t];
  }
};

/// Notes the faces of own tetrahedra that nothing joins.
struct NoteExposed {
  static constexpr const char* name = "fdem3.note_exposed";
  View<const FaceJoints> faces;
  View<const JointStage> stage;
  OwnedView owned;
  View<std::uint8_t> exposed;
  BR_HD void operator()(Index t) const {
    if (owned(t)) exposed[t] = static_cast<std::uint8_t>(exposed_faces(faces[t], stage));
  }
};

/// Whether a couple can touch, and is of this rank. Neighbours across a face do once nothing joins
/// them; neighbours at an edge or a vertex do once a joint around it is damaged.
struct MayTouch {
  OpenVertices vertices;
  View<const FaceJoints> faces;
  View<const JointStage> stage;
  View<const std::uint8_t> exposed;
  OwnedView owned;
  View<const Index> a, b;

  BR_HD bool operator()(Index i) const {
    const Index p = a[i], q = b[i];
    if (!owned(p) && !owned(q)) return false;
    // Exposed faces alone press; a joint that breaks exposes its faces and calls for a search.
    if ((exposed[p] | exposed[q]) == 0) return false;
    int shared = 0, open = 0, apart = 0;  // apart: the corner of p that q lacks
    for (int k = 0; k < 4; ++k) {
      const Index vertex = vertices.vertex_of[4 * p + k];
      bool common = false;
      for (int m = 0; m < 4; ++m) common = common || vertex == vertices.vertex_of[4 * q + m];
      if (!common) {
        apart = k;
        continue;
      }
      ++shared;
      open |= vertices.open(vertex);
    }
    if (shared == 0) return true;
    if (shared < 3) return (open & 6) != 0;
    const Index entry = faces[p].at[apart];
    if (entry < 0) return entry == face_free;
    return is_parted(stage[pair_of(entry)]);
  }
};

/// Share of the corners of a tetrahedron in the common motion.
struct MotionOf {
  View<const TetrahedronNodes> nodes;
  OwnedView owned;
  BR_HD CommonMotion operator()(Index t) const {
    CommonMotion motion;
    if (!owned(t)) return motion;
    for (const NodeState& n : nodes[t].at) motion.add(n.velocity);
    return motion;
  }
};

/// Energy spent by couples that leave the list.
struct SpentBy {
  View<const Index> couple, a;
  View<const CoupleState> state;
  OwnedView owned;  ///< the owner of a books it
  BR_HD Energies operator()(Index k) const {
    Energies spent;
    if (!owned(a[couple[k]])) return spent;
    const CoupleState& s = state[couple[k]];
    spent.friction.add(s.rubbed + (s.slid + s.sprung));
    spent.contact.add(s.lost + s.work - (s.slid + s.sprung));
    return spent;
  }
};

/// The joint between the two of a couple, if it broke lately, or -1: faces that meet again later
/// begin anew.
struct BornOf {
  static constexpr const char* name = "fdem3.born_of";
  double lately;  ///< the time from which on a break counts  [s]
  View<const Index> a, b;
  View<const FaceJoints> faces;
  View<const Index> face_a, face_b;
  View<const double> broke_at;
  View<Index> parent_joint;
  BR_HD void operator()(Index i) const {
    parent_joint[i] = -1;
    for (int k = 0; k < 4; ++k) {
      const Index entry = faces[a[i]].at[k];
      if (entry < 0) continue;
      const Index joint = pair_of(entry);
      const Index other = (side_of(entry) == 0 ? face_b[joint] : face_a[joint]) / 4;
      if (other == b[i] && broke_at[joint] >= lately) parent_joint[i] = joint;
    }
  }
};

}  // namespace breccia::fdem3
