// Bodies that a stage takes out: what was between them and what stays. Their own method does the
// rest.

#include "coupled/world.hpp"
#include "exec/for_each.hpp"

namespace breccia::coupled {
namespace {

/// Bonds let go for good. What they have spent by softening stays booked.
struct LetGo {
  static constexpr const char* name = "coupled.let_go";
  BondsView bonds;
  View<const std::uint8_t> gone;  ///< of bodies of tetrahedra
  View<BallBondState> state;

  BR_HD void operator()(Index i) const {
    const BallBond& tie = bonds.of.tie[i];
    BallBondState& bond = state[i];
    if (!dem::is_gone(bonds.of.fixed[tie.sphere]) && gone[tie.body] == 0) return;
    if (bond.stage == BondStage::parted) return;
    bond.work -= bonds.stored(i, bond);
    bond.force = {};
    bond.on_point = {};
    bond.stage = BondStage::parted;
  }
};

/// Touches end; what friction has spent stays booked.
struct EndTouches {
  static constexpr const char* name = "coupled.end_touches";
  View<const std::uint8_t> fixed;  ///< of spheres
  View<const std::uint8_t> gone;   ///< as of LetGo
  View<const SphereRow> rows;
  View<const Index> row_of, body;
  View<TouchState> state;

  BR_HD void operator()(Index i) const {
    if (!dem::is_gone(fixed[rows[row_of[i]].sphere]) && gone[body[i]] == 0) return;
    TouchState after{};
    after.rubbed = state[i].rubbed + state[i].slid;
    after.lost = state[i].lost;
    state[i] = after;
  }
};

}  // namespace

void cut_off_removed(World& w) {
  const Exec& exec = w.spheres->exec;
  follow_all_owners(w);
  Buffer<std::uint8_t> bodies(exec.space);
  copy_to(bodies, w.tetrahedra->given->removed);
  const View<const std::uint8_t> gone = std::as_const(bodies).view();
  const double before = held(w).elastic.value();
  for_each(exec, w.bonds.size(), LetGo{bonds_view(w), gone, w.bonds.state.view()});
  for_each(exec, w.touches.size(),
           EndTouches{meeting(w).fixed, gone, std::as_const(w.rows).view(),
                      std::as_const(w.row_of_touch).view(), std::as_const(w.touches.pairs.b).view(),
                      w.touches.history.state.view()});
  w.ledger.came_in.add(held(w).elastic.value() - before);
  w.last.of_spheres = -1;  // the next step lists faces anew, without theirs
}

}  // namespace breccia::coupled
