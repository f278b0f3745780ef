#include "fdem/setup/removal.hpp"

#include "fdem/shape.hpp"
#include "fdem_shared/setup/removal.hpp"

namespace breccia::fdem {

std::vector<std::uint8_t> gone_triangles(const World& w) {
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
  fdem_shared::cut_off(w, [&](const std::vector<TriangleNodes>& nodes, const Joints& j, Index i) {
    const JointWork& work = j.work.data()[i];
    if (j.stage.data()[i] != JointStage::softened) return SpentByCut{};
    const JointEnds e = JointEnds::of(j.edge_a.data()[i], j.edge_b.data()[i]);
    const auto place = [&](Index n) { return nodes[at(n / 3)].at[n % 3].position; };
    const Vec2 offset = j.preset.size() > 0 ? j.preset.data()[i] : Vec2{};
    const StoredEnergy held = stored_in(
        bonds[at(j.law.data()[i])], j.strength.data()[i], j.length.data()[i], offset,
        opening_of(place(e.a0), place(e.a1), place(e.b0), place(e.b1)), j.points.data()[i]);
    return SpentByCut::of(work, held, rubbed(j, i));
  });
}

}  // namespace breccia::fdem
