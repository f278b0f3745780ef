#pragma once
// The ledger of a mesh: every joule, summed exactly. Each rank sums up what it owns, and exact sums
// add up to those of the whole. Made for each method in its energy.cpp, which says what elements
// and joints store.

#include <algorithm>

#include "core/energy_split.hpp"
#include "domain/owned.hpp"
#include "exec/fold_sum.hpp"
#include "fdem_shared/element_energies.hpp"
#include "fdem_shared/laws/residual_work.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

template <class Shape>
struct GravityPotential {
  typename Shape::Vector gravity;  ///<  [m/s2]
  View<const typename Shape::Nodes> nodes;
  View<const double> mass;
  BR_HD void add_to(Energies& sum, Index t) const {
    for (const auto& n : nodes[t].at) sum.potential.add(mass[t] * dot(gravity, n.position));
  }
};

/// @tparam Stored  a method's: stored(i), what joint i would give back if it were unloaded now
template <class Stage, class Work, class Inherited, class Rubbed, class Stored>
struct JointShares {
  View<const Stage> stage;
  View<const Work> work;
  Inherited inherited_work;
  Rubbed rubbed;  ///< work of residual friction
  Stored stored;

  BR_HD void add_to(Energies& s, Index i) const {
    if (stage[i] == Stage::dormant) return;
    const Work& taken = work[i];
    if (stage[i] == Stage::cut) {  // after that it took work out of the model
      const Work inherited = inherited_work[i];
      s.fracture.add(inherited.open);
      add_slide(s, i, inherited.slide, 0.0);
      s.work.add(inherited.open - taken.open);
      s.work.add(inherited.slide - taken.slide);
      return;
    }
    if (stage[i] == Stage::broken) {
      const Work inherited = inherited_work[i];
      s.fracture.add(taken.open - inherited.open);
      add_slide(s, i, taken.slide - inherited.slide, inherited.slide);
      return;
    }
    const auto held = stored(i);
    if (stage[i] == Stage::whole) {  // pressure took this on its slip, and gives it on the way back
      s.elastic.add((held.open + held.slide) + (taken.open + taken.slide));
      return;
    }
    s.elastic.add(held.open + held.slide);
    const Work beyond{taken.open - held.open, taken.slide - held.slide};
    const Work spent = beyond.spent();
    s.fracture.add(spent.open);
    add_slide(s, i, spent.slide, held.rubs);
    if (!(beyond.open + beyond.slide > 0.0)) s.elastic.add(beyond.open + beyond.slide);
  }
  /// Of joints [begin, end), where the method adds whole ones by packs.
  void add_run(Energies& s, Index begin, Index end) const requires requires {
    stored.add_whole(s.elastic, stage, work, begin, end);
  }
  {
    while (begin < end) {
      begin = stored.add_whole(s.elastic, stage, work, begin, end);
      for (const Index next = std::min(end, begin + stored.width()); begin < next; ++begin)
        add_to(s, begin);
    }
  }
  /// Energies that joint i has spent by sliding: on friction, and on its fracture.
  /// @param held  of the work of friction, what springs hold
  BR_HD void add_slide(Energies& s, Index i, double slide, double held) const {
    const double rubs = spent_on_friction(rubbed[i], held, slide);
    s.friction.add(rubs);
    s.sliding.add(slide - rubs);
  }
};

template <class State>
struct CoupleShares {
  View<const State> state;
  BR_HD void add_to(Energies& s, Index i) const {
    s.elastic.add(state[i].work - state[i].slid);
    s.friction.add(state[i].slid + state[i].rubbed);
    s.contact.add(state[i].lost);
  }
};

/// Energies that a rank's own elements hold and have spent, and the joints and couples whose first
/// element it owns.
template <class World>
std::function<Energies()> held_by_part(const World& w) {
  using Shape = ShapeOf<World>;
  const auto& t = Shape::elements(w);
  const auto of_elements = stored_by_elements(w);
  const auto& j = w.joints;
  const auto of_joints = stored_by_joints(w);
  using Stage = std::remove_cvref_t<decltype(j.stage.view()[0])>;
  using Work = std::remove_cvref_t<decltype(j.work.view()[0])>;
  const auto state = w.couples.history.state.view();
  const typename Shape::Vector gravity = w.given->gravity;
  const Index falling = dot(gravity, gravity) > 0.0 ? t.size() : 0;
  FoldSum<Energies> all(w.exec);
  const auto own = [&w](const auto& kernel, const auto& element_of) {
    return of_owned(w.domain, Energies{}, kernel, element_of);
  };
  all.add_parts(part(
      t.size(),
      own(ElementShares<std::remove_cv_t<decltype(of_elements)>>{of_elements, t.external.view(),
                                                                 t.viscous_work.view(),
                                                                 t.damping_work.view(),
                                                                 t.load_work.view()},
          ItemItself{}),
      part(j.size(),
           own(
               JointShares<Stage, Work, decltype(works_inherited(j)), decltype(works_rubbed(j)),
                           std::remove_cv_t<decltype(of_joints)>>{
                   j.stage.view(), j.work.view(), works_inherited(j), works_rubbed(j), of_joints},
               ListedElement<Shape::corners>{Shape::side_a(j).view()}),
           part(w.couples.size(),
                own(CoupleShares<std::remove_cvref_t<decltype(state[0])>>{state},
                    ListedElement<>{w.couples.pairs.a.view()}),
                part(falling,
                     own(GravityPotential<Shape>{gravity, t.nodes.view(), t.mass.view()},
                         ItemItself{}),
                     Parts<>{})))));
  return all.sum_later();
}

/// Starts the ledger at the present state.
template <class World>
void start_ledger(World& w) {
  w.ledger = {};
  const Energies all = held(w);
  w.ledger.start_potential = all.potential;
  w.ledger.start = all.kinetic.value() + all.elastic.value();
}

}  // namespace breccia::fdem_shared
