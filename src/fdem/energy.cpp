// The ledger of an FDEM run, per unit thickness: energies of triangles and joints, and what
// fdem_shared/energies.hpp makes of them.

#include "fdem/joints/joint_energies.hpp"
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
          j.points.view(),
          w.lanes};
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
