// Bodies that a stage takes out: what was between them and what stays. Their own method does the
// rest.

#include "coupled/world.hpp"

namespace breccia::coupled {
namespace {

bool is_gone(const World& w, Index sphere) {
  return dem::is_gone(w.spheres->elements.fixed.data()[sphere]);
}

/// A bond lets go for good. What it has spent by softening stays booked.
void let_go(const World& w, const BallBond& tie, BallBondState& bond) {
  if (bond.stage == BondStage::parted) return;
  bond.work -= stored_in(w, tie, bond);
  bond.force = {};
  bond.on_point = {};
  bond.stage = BondStage::parted;
}
/// A touch ends; what friction has spent stays booked.
void end(TouchState& touch) {
  TouchState after{};
  after.rubbed = touch.rubbed + touch.slid;
  after.lost = touch.lost;
  touch = after;
}

}  // namespace

bool is_gone_body(const World& w, Index body) {
  const std::vector<std::uint8_t>& removed = w.tetrahedra->given->removed;
  return removed[static_cast<std::size_t>(body)] != 0;
}

void cut_off_removed(World& w) {
  const double before = held(w).elastic.value();
  for (Index i = 0; i < w.bonds.size(); ++i) {
    const BallBond& tie = w.bonds.tie.data()[i];
    if (is_gone(w, tie.sphere) || is_gone_body(w, tie.body))
      let_go(w, tie, w.bonds.state.data()[i]);
  }
  for (Index i = 0; i < w.touches.size(); ++i)
    if (is_gone(w, w.touches.pairs.a.data()[i]) || is_gone_body(w, w.touches.pairs.b.data()[i]))
      end(w.touches.history.state.data()[i]);
  w.ledger.came_in.add(held(w).elastic.value() - before);
  w.last.of_spheres = -1;  // the next step lists faces anew, without theirs
}

}  // namespace breccia::coupled
