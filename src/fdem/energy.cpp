// The ledger of an FDEM run, per unit thickness: energies of triangles and joints, and what
// fdem_shared/energies.hpp makes of them.

#include "fdem/joints/joint_energies.hpp"
#include "fdem/shape.hpp"
#include "fdem/triangles/triangle_energies.hpp"
#include "fdem_shared/energies.hpp"

namespace breccia::fdem {
StoredByTriangles stored_by_elements(const World& w) {
  return {kick(w), laws_of(w), w.given->laws.view(), w.triangles.shape_inverse.view(), w.lanes};
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

}  // namespace breccia::fdem
