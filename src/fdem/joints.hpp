#pragma once
// What ties triangles along their common edges: arrays and the kernel of one launch.

#include "exec/buffer.hpp"
#include "fdem/laws/joint_bond.hpp"
#include "fdem/triangles.hpp"

namespace breccia::fdem {

/// How far a joint has gone.
enum class JointStage : std::uint8_t { whole, softened, broken };

/// Integration points: at the first end, in the middle, at the second end; weights 1/6, 4/6, 1/6.
struct JointPoints {
  BondState<double> point[3];
};

/// Forces of a joint on the two nodes of its side a; those of side b get the opposite.  [N/m]
struct JointForce {
  Vec2 first, second;
};

/// Work that a joint has taken up, by direction.  [J/m]
struct JointWork {
  double open = 0.0, slide = 0.0;
};

/// Cohesive joints. Edge 3 t + k leads from corner k of triangle t to the next one. Side a is the
/// triangle with the lower global id; its edge's first node lies at the second node of side b's.
struct Joints {
  Buffer<Index> edge_a, edge_b;  ///< the two edges that it joins
  Buffer<std::int16_t> law;      ///< index into World::bonds  [-]
  Buffer<double> length;         ///< at the start  [m]
  Buffer<double> strength;       ///< over its law's  [-]
  Buffer<Vec2> preset;         ///< opening and slip that carry the in-situ stress; empty: none  [m]
  Buffer<JointStage> stage;    ///<  [-]
  Buffer<JointPoints> points;  ///< damage and largest opening and slip
  Buffer<JointForce> force;    ///< of this time  [N/m]
  Buffer<JointWork> work;      ///< taken up so far  [J/m]
  Buffer<double> broke_at;     ///< time of its break, -1: whole, -2: broken from the start  [s]
  Buffer<double> pressing;     ///< compressive force when it broke  [N/m]

  template <class Visit>
  void each_field(Visit&& field) {
    field("edge_a", "-", edge_a);
    field("edge_b", "-", edge_b);
    field("law", "-", law);
    field("length", "m", length);
    field("strength", "-", strength);
    field("preset", "m", preset);
    field("stage", "-", stage);
    field("points", "-", points);
    field("force", "N/m", force);
    field("work", "J/m", work);
    field("broke_at", "s", broke_at);
    field("pressing", "N/m", pressing);
  }
  Index size() const { return edge_a.size(); }
};

/// How a joint is open: axes and relative displacements at its ends.
struct JointOpening {
  Vec2 along, across;  ///< e of the middle line, and n from side b into side a  [-]
  double open[3];      ///< at the integration points  [m]
  double slide[3];     ///< of side a against b along e  [m]
  bool collapsed;      ///< the middle line has no length left
};

/// The four nodes of a joint: a0, a1 along side a; b0 faces a0, b1 faces a1.
struct JointNodes {
  NodeState a0, a1, b0, b1;

  BR_HD JointNodes(const View<const TriangleNodes>& nodes, Index edge_a, Index edge_b) {
    const TriangleNodes &a = nodes[edge_a / 3], &b = nodes[edge_b / 3];
    const int k = edge_a % 3, m = edge_b % 3;
    a0 = a.at[k];
    a1 = a.at[k == 2 ? 0 : k + 1];
    b1 = b.at[m];
    b0 = b.at[m == 2 ? 0 : m + 1];
  }
};

BR_HD inline JointOpening opening_of(const JointNodes& n, double length) {
  JointOpening o;
  const Vec2 line = 0.5 * ((n.a1.position - n.a0.position) + (n.b1.position - n.b0.position));
  const double size = norm(line);
  o.collapsed = !(size > 1e-12 * length);
  if (o.collapsed) return o;
  o.along = (1.0 / size) * line;
  o.across = {-o.along.y, o.along.x};
  const Vec2 first = n.a0.position - n.b0.position, second = n.a1.position - n.b1.position;
  o.open[0] = dot(first, o.across);
  o.open[2] = dot(second, o.across);
  o.slide[0] = dot(first, o.along);
  o.slide[2] = dot(second, o.along);
  o.open[1] = 0.5 * (o.open[0] + o.open[2]);
  o.slide[1] = 0.5 * (o.slide[0] + o.slide[2]);
  return o;
}

/// Says so to the host, whichever item does it first.
BR_HD inline void raise(const View<std::uint8_t>& flag) {
#if defined(__CUDA_ARCH__)
  flag[0] = 1;
#else
  __atomic_store_n(&flag[0], std::uint8_t{1}, __ATOMIC_RELAXED);
#endif
}

/// Tractions at three points, work, damage and break of every joint (Lukas 2014, section 2).
struct JointForces {
  static constexpr const char* name = "fdem.joints";
  double time, dt;  ///< of the positions, and the step that led there  [s]
  View<const TriangleNodes> nodes;
  View<const JointBond> bonds;
  View<const Index> edge_a, edge_b;
  View<const std::int16_t> law;
  View<const double> length, strength;
  View<const Vec2> preset;
  View<JointStage> stage;
  View<JointPoints> points;
  View<JointForce> force;
  View<JointWork> work;
  View<double> broke_at, pressing;
  View<std::uint8_t> changed;  ///< raised when a joint softens or breaks: contacts must be searched

  BR_HD void operator()(Index i) const {
    const JointStage before = stage[i];
    if (before == JointStage::broken) {
      force[i] = {};
      return;
    }
    const JointNodes n(nodes, edge_a[i], edge_b[i]);
    const double h = length[i];
    JointOpening o = opening_of(n, h);
    if (o.collapsed) {
      finish(i);
      force[i] = {};
      return;
    }
    const JointBond& bond = bonds[law[i]];
    const Vec2 offset = preset.size > 0 ? preset[i] : Vec2{};
    JointPoints state{};
    if (before != JointStage::whole) state = points[i];
    Vec2 traction[3];
    double pressure = 0.0;
    int failed = 0;
    bool damaged = false;
    for (int q = 0; q < 3; ++q) {
      const BondTraction<double> t =
          answer(bond, strength[i], h, o.open[q] + offset.x, o.slide[q] + offset.y, state.point[q]);
      traction[q] = t.shear * o.along + t.normal * o.across;
      pressure -= (q == 1 ? 4.0 : 1.0) * t.normal;
      failed += state.point[q].damage >= 1.0 ? 1 : 0;
      damaged = damaged || state.point[q].damage > 0.0;
    }
    const double share = -h / 6.0;
    const JointForce now{share * (traction[0] + 2.0 * traction[1]),
                         share * (traction[2] + 2.0 * traction[1])};
    book_work(i, n, o, now);
    force[i] = now;
    if (damaged) {
      points[i] = state;
      if (before == JointStage::whole) {
        stage[i] = JointStage::softened;
        raise(changed);
      }
      if (failed >= 2) {
        pressing[i] = larger(0.0, pressure * h / 6.0);
        finish(i);
      }
    }
  }

 private:
  /// Work of this step by the trapezoidal rule: with leapfrog velocities it sums to exactly what
  /// the nodes lose.
  BR_HD void book_work(Index i, const JointNodes& n, const JointOpening& o,
                       const JointForce& now) const {
    const Vec2 first = dt * (n.a0.velocity - n.b0.velocity);
    const Vec2 second = dt * (n.a1.velocity - n.b1.velocity);
    const JointForce& last = force[i];
    const Vec2 f = last.first + now.first, s = last.second + now.second;
    JointWork& w = work[i];
    w.open -=
        0.5 * (dot(f, o.across) * dot(first, o.across) + dot(s, o.across) * dot(second, o.across));
    w.slide -=
        0.5 * (dot(f, o.along) * dot(first, o.along) + dot(s, o.along) * dot(second, o.along));
  }
  BR_HD void finish(Index i) const {
    stage[i] = JointStage::broken;
    broke_at[i] = time;
    raise(changed);
  }
};

}  // namespace breccia::fdem
