#include "fdem3/setup/removal.hpp"

#include "fdem3/shape.hpp"
#include "fdem_shared/setup/removal.hpp"

namespace breccia::fdem3 {

std::vector<std::uint8_t> gone_tetrahedra(const World& w) {
  return fdem_shared::gone_elements(w);
}

void open_around_removed(World& w) {
  fdem_shared::open_around(w);
}

/// Energy spent by a joint that is not broken: none by a whole one; else of the work it took up,
/// less what it still holds.
void cut_off_removed(World& w) {
  std::vector<JointBond> bonds;
  copy_to(bonds, w.given->bonds);
  fdem_shared::cut_off(
      w, [&](const std::vector<TetrahedronNodes>& nodes, const Joints& j, Index i) {
        const JointWork& work = j.work.data()[i];
        if (j.stage.data()[i] != JointStage::softened) return fdem::SpentByCut{};
        const JointEnds e = JointEnds::of(j.face_a.data()[i], j.face_b.data()[i], j.turn.data()[i]);
        Vec3 a[3], b[3];
        for (int k = 0; k < 3; ++k) {
          a[k] = nodes[at(e.a[k] / 4)].at[e.a[k] % 4].position;
          b[k] = nodes[at(e.b[k] / 4)].at[e.b[k] % 4].position;
        }
        const Vec3 offset = j.preset.size() > 0 ? j.preset.data()[i] : Vec3{};
        const fdem::StoredEnergy held =
            stored_in(bonds[at(j.law.data()[i])], j.strength.data()[i], j.length.data()[i],
                      j.shape.data()[i].area(), offset, opening_of(a, b), points_of(j, i));
        return fdem::SpentByCut::of(work, held, rubbed(j, i));
      });
}

}  // namespace breccia::fdem3
