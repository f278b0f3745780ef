// The ledger of an FDEM run, per unit thickness: energies of triangles and joints, and what
// fdem_shared/energies.hpp makes of them.

#include "fdem/shape.hpp"
#include "fdem_shared/energies.hpp"

namespace breccia::fdem {
namespace {

struct StoredByTriangles {
  Kick kick;
  View<const Index> material;
  View<const ElasticTriangle> laws;
  View<const Mat2> shape_inverse;

  BR_HD double elastic(Index t) const {
    Vec2 x[3], v[3];
    split(kick.nodes[t], x, v);
    const Mat2& inverse_shape = shape_inverse[t];
    const double area = 0.5 / determinant(inverse_shape);
    return area * laws[material[t]].energy(deformation(inverse_shape, x, v));
  }
};

struct StoredByJoints {
  View<const NodeState> nodes;
  View<const JointBond> bonds;
  View<const JointEnds> ends;
  View<const Index> law;
  View<const double> length, strength;
  View<const Vec2> preset;
  View<const JointPoints> points;

  BR_HD StoredEnergy operator()(Index i) const {
    const JointEnds& e = ends[i];
    const JointOpening<double> o = opening_of(nodes[e.a0].position, nodes[e.a1].position,
                                              nodes[e.b0].position, nodes[e.b1].position);
    const Vec2 offset = preset.size > 0 ? preset[i] : Vec2{};
    return stored_in(bonds[law[i]], strength[i], length[i], offset, o, points[i]);
  }
};

}  // namespace

StoredByTriangles stored_by_elements(const World& w) {
  return {kick(w), laws_of(w), w.given->laws.view(), w.triangles.shape_inverse.view()};
}
StoredByJoints stored_by_joints(const World& w) {
  const Joints& j = w.joints;
  return {by_number(w.triangles.nodes.view()),
          w.given->bonds.view(),
          w.joint_ends.view(),
          j.law.view(),
          j.length.view(),
          j.strength.view(),
          j.preset.view(),
          j.points.view()};
}

Energies held(const World& w) {
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

}  // namespace breccia::fdem
