#pragma once
// Where the stress between two tetrahedra that move as one reaches the strength of their joint.

#include "core/kernel.hpp"
#include "fdem3/laws/rock_failure.hpp"
#include "fdem3/world.hpp"

namespace breccia::fdem3 {

struct TetrahedronStress {
  static constexpr const char* name = "fdem3.stress";
  View<const TetrahedronNodes> nodes;
  View<const Index> law_of;
  View<const ElasticTetrahedron> laws;
  View<const ShapeGradients> shape;
  View<Sym3> stress;
  BR_HD void set(const StepTime&) {}
  BR_HD void operator()(Index t) const {
    Vec3 x[4];
    places(nodes[t], x);
    stress[t] = laws[law_of[t]].stress(deformation(shape[t], x));
  }
};

/// Dormant joints: the stress over the strength of each, and its waking.
struct Sleeper {
  View<const TetrahedronNodes> nodes;
  View<const Index> face_a, face_b;
  View<const std::uint8_t> turn;
  View<const Sym3> stress;  ///< of tetrahedra
  View<const JointBond> bonds;
  View<const Index> law;
  View<const FaceShape> shape;
  View<const double> strength, length;
  View<JointStage> stage;
  View<Vec3> preset;

  BR_HD bool sleeps(Index i) const { return stage[i] == JointStage::dormant; }
  /// Stress over strength: tension, or shear by Mohr and Coulomb, and that of the rock beside it.
  BR_HD double overshoot(Index i) const {
    const RockStress rock = stress_at(i, face_of(i));
    const Sym3& s = rock.s;
    const JointBond& bond = bonds[law[i]];
    const double resists = bond.cohesion * strength[i] - bond.friction * min(s.zz, 0.0);
    const double shear = sqrt(s.xz * s.xz + s.yz * s.yz);
    const double most = max(s.zz / (bond.tension * strength[i]), shear / resists);
    return bond.by_rock() ? max(most, rock_failure(bond, strength[i], rock).most()) : most;
  }
  /// @returns what it stores then  [J]
  BR_HD double wake(Index i, double share) const {
    const JointBond& bond = bonds[law[i]];
    const JointOpening face = face_of(i);
    const Sym3 s = stress_at(i, face).s;
    Vec3 opening{};
    preset_opening(bond, strength[i], length[i], share * Vec3{s.zz, s.xz, s.yz}, opening);
    preset[i] += opening;
    stage[i] = JointStage::whole;
    const fdem::StoredEnergy stored =
        stored_in(bond, strength[i], length[i], shape[i].area(), opening, face, JointPoints{});
    return stored.open + stored.slide;
  }

 private:
  /// It is closed: both sides' corners lie at one place.
  BR_HD JointOpening face_of(Index i) const {
    const JointEnds e = JointEnds::of(face_a[i], face_b[i], turn[i]);
    Vec3 corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = nodes[e.b[k] / 4].at[e.b[k] % 4].position;
    return opening_of(corner, corner);
  }
  /// The mean of its two tetrahedra's, in the frame of the face: along its first edge, across it,
  /// normal.  [Pa]
  BR_HD RockStress stress_at(Index i, const JointOpening& o) const {
    const Sym3 &a = stress[face_a[i] / 4], &b = stress[face_b[i] / 4];
    const Sym3 mean{0.5 * (a.xx + b.xx), 0.5 * (a.yy + b.yy), 0.5 * (a.zz + b.zz),
                    0.5 * (a.yz + b.yz), 0.5 * (a.xz + b.xz), 0.5 * (a.xy + b.xy)};
    const Vec3 across = cross(o.normal, o.along);
    const Vec3 on_along = mean * o.along, on_across = mean * across, on_face = mean * o.normal;
    return {{dot(on_along, o.along), dot(on_across, across), dot(on_face, o.normal),
             dot(on_face, across), dot(on_face, o.along), dot(on_along, across)}};
  }
};

inline TetrahedronStress stress_kernel(World& w) {
  return {std::as_const(w.tetrahedra.nodes).view(), laws_of(w), w.given->laws.view(),
          std::as_const(w.tetrahedra.shape).view(), w.stress.view()};
}
inline Sleeper sleeper_of(World& w) {
  Joints& j = w.joints;
  return {std::as_const(w.tetrahedra.nodes).view(),
          std::as_const(j.face_a).view(),
          std::as_const(j.face_b).view(),
          std::as_const(j.turn).view(),
          std::as_const(w.stress).view(),
          w.given->bonds.view(),
          std::as_const(j.law).view(),
          std::as_const(j.shape).view(),
          std::as_const(j.strength).view(),
          std::as_const(j.length).view(),
          j.stage.view(),
          j.preset.view()};
}

}  // namespace breccia::fdem3
