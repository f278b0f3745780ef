#pragma once
// Spheres tied to tetrahedra by cohesive bonds of one point (docs/theory-coupled.md, 3).

#include "coupled/touches.hpp"
#include "fdem/laws/joint_bond.hpp"

namespace breccia::coupled {

/// The vector in space that a vector has become with its sphere.
BR_HD inline Vec3 turned(const Quaternion& q, const Vec3& v) {
  const Vec3 axis{q.x, q.y, q.z};
  const Vec3 t = 2.0 * cross(axis, v);
  return v + q.w * t + cross(axis, t);
}

/// Both ends of a bond, for ever.
struct BallBond {
  Index sphere, tetrahedron;
  Index law, body;
  double share[4];  ///< of the tied point by the corners  [-]
  Vec3 arm;         ///< r_0, from the centre to the point, in the frame of the sphere  [m]
  double length;    ///< L_0 = |r_0|  [m]
  double area;      ///< S  [m2]
};

enum class BondStage : std::int64_t {
  whole,   ///< it has not broken
  broken,  ///< no strength is left, but both still press on each other
  parted   ///< it is gone: contact takes over
};
struct BallBondState {
  fdem::BondState<double> point;
  SphereForce force;  ///< on the sphere
  Vec3 on_point;      ///< on the tied point: the opposite  [N]
  double work;        ///< taken up so far  [J]
  double broke_at;    ///< [s]
  BondStage stage;
};

struct BallBonds {
  Buffer<BallBond> tie;
  Buffer<BallBondState> state;
  template <class Visit>
  void each_field(Visit&& field) {
    field("tie", "-", tie);
    field("state", "-", state);
  }
  Index size() const { return tie.size(); }
};

/// Opening and slip of a bond.
struct BondGap {
  Vec3 normal, slip;   ///< [-], [m]
  double open, slide;  ///< [m]
  Vec3 lever;          ///< from the centre to the tied point  [m]
};
BR_HD inline BondGap gap_of(const BallBond& b, const dem::ElementState& s, const Quaternion& turn,
                            const fdem3::TetrahedronNodes& n) {
  Vec3 point{};
  for (int k = 0; k < 4; ++k) point += b.share[k] * n.at[k].position;
  const Vec3 arm = turned(turn, b.arm);
  BondGap g{(1.0 / b.length) * arm, {}, 0.0, 0.0, point - s.position};
  const Vec3 gap = g.lever - arm;
  g.open = dot(gap, g.normal);
  g.slip = gap - g.open * g.normal;
  g.slide = norm(g.slip);
  return g;
}

/// The law of joints over one point: total, without drift.
struct BondForces {
  static constexpr const char* name = "coupled.bonds";
  double time, dt;  ///< of the positions, and the step that led here  [s]
  View<const dem::ElementState> spheres;
  View<const Quaternion> orientation;
  View<const fdem3::TetrahedronNodes> nodes;
  View<const fdem::JointBond> laws;
  View<const BallBond> tie;
  View<BallBondState> state;

  BR_HD void operator()(Index i) const {
    BallBondState& kept = state[i];
    if (kept.stage == BondStage::parted) return;  // its forces are zero already
    const BallBond& b = tie[i];
    const fdem::JointBond& law = laws[b.law];
    const dem::ElementState& s = spheres[b.sphere];
    const fdem3::TetrahedronNodes& n = nodes[b.tetrahedron];
    const BondGap g = gap_of(b, s, orientation[b.sphere], n);
    const fdem::BondTraction<double> t =
        fdem::edge_response(law, 1.0, b.length, g.open, g.slide, kept.point);
    if (kept.stage == BondStage::whole && kept.point.damage >= 1.0) {
      kept.stage = BondStage::broken;
      kept.broke_at = time;
    }
    constexpr double farthest = 0.1;  // slip over L_0 for which the tied point stands for the face
    if (kept.stage == BondStage::broken && (g.open >= 0.0 || g.slide > farthest * b.length))
      kept.stage = BondStage::parted;
    SphereForce now{};
    if (kept.stage != BondStage::parted) {
      const double along = g.slide > 0.0 ? t.shear / g.slide : 0.0;
      now.force = b.area * (t.normal * g.normal + along * g.slip);
      now.torque = cross(g.lever, now.force);
      // Rows of three: the sphere's way, its turn, and the tied point's way (the rule has two).
      now.straight = 1.5 * b.area * law.stiffness / b.length;
      now.turning = now.straight * dot(g.lever, g.lever);
    }
    Vec3 velocity{};
    for (int k = 0; k < 4; ++k) velocity += b.share[k] * n.at[k].velocity;
    const SphereForce last = kept.force;
    kept.force = now;
    kept.on_point = -now.force;
    kept.work -= 0.5 * dt *
                 (dot(last.force + now.force, s.velocity - velocity) +
                  dot(last.torque + now.torque, s.spin));
  }
};

/// Whether spheres are still tied to a body: where they are they do not press on it.
struct MarkBonded {
  static constexpr const char* name = "coupled.mark_bonded";
  View<const SphereRow> rows;
  View<const BallBond> tie;
  View<const BallBondState> state;
  View<std::int16_t> bonded;  ///< of each row

  BR_HD void operator()(Index i) const {
    std::int16_t body = -1;
    for (Index b = rows[i].bond; b < rows[i].bond_end; ++b)
      if (state[b].stage != BondStage::parted) body = static_cast<std::int16_t>(tie[b].body);
    bonded[i] = body;
  }
};

}  // namespace breccia::coupled
