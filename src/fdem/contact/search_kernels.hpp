#pragma once
// Kernels of the couple search: which triangles can touch, and which pairs of them.

#include "core/energy.hpp"
#include "domain/drift.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {

/// Marks the vertices of damaged joints.
struct MarkDamaged {
  static constexpr const char* name = "fdem.mark_damaged";
  View<const JointStage> stage;
  View<const Index> edge_a, vertex_of;
  View<std::uint8_t> marked;
  BR_HD void operator()(Index i) const {
    if (!is_damaged(stage[i]) && stage[i] != JointStage::cut) return;
    set_flag(marked, vertex_of[edge_a[i]]);
    set_flag(marked, vertex_of[JointEnds::next_corner(edge_a[i])]);
  }
};

/// How the vertices of the mesh are open.
struct OpenVertices {
  View<const Index> vertex_of;               ///< of each node
  View<const std::uint8_t> border, damaged;  ///< World::open_vertex, ExposedVertices::vertex

  /// World::open_vertex, and bit 2: a joint here is damaged.
  BR_HD int open(Index vertex) const { return border[vertex] | (damaged[vertex] != 0 ? 4 : 0); }
};

/// Triangles with a corner at the border, at an edge that nothing joins, or at a damaged joint, but
/// those that have been taken out.
struct Touchable {
  OpenVertices vertices;
  View<const Index> hold;
  View<const Hold> holds;
  BR_HD bool operator()(Index t) const {
    if (is_gone(holds, hold[t])) return false;
    int open = 0;
    for (Index k = 0; k < 3; ++k) open |= vertices.open(vertices.vertex_of[3 * t + k]);
    return open != 0;
  }
};

/// From places in the list of triangles that can touch to triangles.
struct NameTriangles {
  static constexpr const char* name = "fdem.name_triangles";
  View<const Index> triangle;
  View<Index> a, b;
  BR_HD void operator()(Index i) const {
    a[i] = triangle[a[i]];
    b[i] = triangle[b[i]];
  }
};

/// Whether a couple can touch, and is of this rank. Neighbours across an edge do once nothing joins
/// them; neighbours at a vertex do once a joint around it is damaged.
struct MayTouch {
  OpenVertices vertices;
  View<const EdgeJoints> edges;
  View<const JointStage> stage;
  OwnedView owned;
  View<const Index> a, b;

  BR_HD bool operator()(Index i) const {
    const Index p = a[i], q = b[i];
    if (!owned(p) && !owned(q)) return false;
    int shared = 0, open = 0;
    bool common[3] = {false, false, false};
    for (Index k = 0; k < 3; ++k)
      for (Index m = 0; m < 3; ++m) {
        const Index vertex = vertices.vertex_of[3 * p + k];
        if (vertex != vertices.vertex_of[3 * q + m]) continue;
        ++shared;
        open |= vertices.open(vertex);
        common[k] = true;
      }
    if (shared == 0) return true;
    if (shared == 1) return (open & 6) != 0;
    const int edge = common[0] && common[1] ? 0 : common[1] && common[2] ? 1 : 2;
    const Index entry = edges[p].at[edge];
    if (entry < 0) return entry == edge_free;
    return is_parted(stage[pair_of(entry)]);
  }
};

/// Contribution of a triangle's corners to the common motion.
struct MotionOf {
  View<const TriangleNodes> nodes;
  OwnedView owned;
  BR_HD CommonMotion operator()(Index t) const {
    CommonMotion motion;
    if (!owned(t)) return motion;
    for (const NodeState& n : nodes[t].at) motion.add({n.velocity.x, n.velocity.y, 0.0});
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

/// The joint between the triangles of a couple, if it broke lately, or -1: faces that meet again
/// later begin anew.
struct BornOf {
  static constexpr const char* name = "fdem.born_of";
  double lately;  ///< the time from which on a break counts  [s]
  View<const Index> a, b;
  View<const EdgeJoints> edges;
  View<const Index> edge_a, edge_b;
  View<const double> broke_at;
  View<Index> parent_joint;
  BR_HD void operator()(Index i) const {
    parent_joint[i] = -1;
    for (int k = 0; k < 3; ++k) {
      const Index entry = edges[a[i]].at[k];
      if (entry < 0) continue;
      const Index joint = pair_of(entry);
      const Index other = (side_of(entry) == 0 ? edge_b[joint] : edge_a[joint]) / 3;
      if (other == b[i] && broke_at[joint] >= lately) parent_joint[i] = joint;
    }
  }
};

}  // namespace breccia::fdem
