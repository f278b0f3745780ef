// The ledger of a run of tetrahedra: energies of tetrahedra and joints, and what
// fdem_shared/energies.hpp makes of them.

#include "fdem3/shape.hpp"
#include "fdem_shared/energies.hpp"

namespace breccia::fdem3 {
namespace {

struct StoredByTetrahedra {
  Kick kick;
  View<const Index> material;
  View<const ElasticTetrahedron> laws;
  View<const ShapeGradients> shape;

  BR_HD double elastic(Index t) const {
    Vec3 x[4];
    places(kick.nodes[t], x);
    const ShapeGradients& g = shape[t];
    return g.volume() * laws[material[t]].energy(deformation(g, x));
  }
};

struct StoredByJoints {
  View<const TetrahedronNodes> nodes;
  View<const JointBond> bonds;
  View<const Index> face_a, face_b;
  View<const std::uint8_t> turn;
  View<const Index> law;
  View<const FaceShape> shape;
  View<const double> length, strength;
  View<const Vec3> preset;
  FailedJoints failure;

  BR_HD fdem::StoredEnergy operator()(Index i) const {
    const JointEnds e = JointEnds::of(face_a[i], face_b[i], turn[i]);
    Vec3 a[3], b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = nodes[e.a[k] / 4].at[e.a[k] % 4].position;
      b[k] = nodes[e.b[k] / 4].at[e.b[k] % 4].position;
    }
    const Vec3 offset = preset.size > 0 ? preset[i] : Vec3{};
    return stored_in(bonds[law[i]], strength[i], length[i], shape[i].area(), offset,
                     opening_of(a, b), failure.part<&JointFailure::points>(i));
  }
};

}  // namespace

StoredByTetrahedra stored_by_elements(const World& w) {
  return {kick(w), laws_of(w), w.given->laws.view(), w.tetrahedra.shape.view()};
}
StoredByJoints stored_by_joints(const World& w) {
  const Joints& j = w.joints;
  return {w.tetrahedra.nodes.view(),
          w.given->bonds.view(),
          j.face_a.view(),
          j.face_b.view(),
          j.turn.view(),
          j.law.view(),
          j.shape.view(),
          j.length.view(),
          j.strength.view(),
          j.preset.view(),
          j.failure.view()};
}

std::function<Energies()> held_later(const World& w) {
  return fdem_shared::held_by_part(w);
}
void begin_ledger(World& w) {
  fdem_shared::start_ledger(w);
}
EnergySplit energy_split(const World& w) {
  return split_of(w.ledger, held(w));
}
EnergySplit energies(World& w) {
  return split_and_note(w.ledger, held(w));
}

}  // namespace breccia::fdem3
