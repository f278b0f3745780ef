// The ledger of a DEM run: every joule, summed exactly.

#include "dem/energy.hpp"

#include <cmath>

#include "dem/free_walls.hpp"
#include "dem/stepping/kernel_lanes.hpp"
#include "domain/owned.hpp"
#include "exec/fold_sum.hpp"

namespace breccia::dem {
namespace {

struct GravityPotential {
  Vec3 gravity;
  View<const ElementState> state_of;
  View<const double> mass;
  BR_HD void add_to(Energies& sum, Index e) const {
    sum.potential.add(mass[e] * dot(gravity, state_of[e].position));
  }
};

/// A kernel whose energies the host adds up by packs.
template <class Kernel>
struct ByPacks {
  Kernel kernel;
  Lanes lanes;
  BR_HD void add_to(Energies& sum, Index i) const { kernel.add_to(sum, i); }
  void add_run(Energies& sum, Index begin, Index end) const {
    add_energies(lanes, kernel, begin, end, sum);
  }
};

template <class Number, class Law>
auto energies_of(const World& w, const LinkSet<Law>& set, const LinkGroup<Law>& g) {
  const auto shares = shares_of<Number>(set, w.elements.state.view());
  using Group = GroupEnergies<Law, std::remove_const_t<decltype(shares)>>;
  const Group group{g.law, g.begin, shares, w.elements.fixed.view()};
  const ListedElement<> first{set.a.view(), g.begin};
  if constexpr (LinkSet<Law>::kind == LinkKind::concrete)
    return of_owned(w.domain, Energies{}, ByPacks<Group>{group, w.lanes}, first);
  else
    return of_owned(w.domain, Energies{}, group, first);
}
/// Links of the first group of a kind, which most models have alone.
template <class Number, class Law, class... Rest>
auto first_group(const World& w, const LinkSet<Law>& set, const Parts<Rest...>& rest) {
  const LinkGroup<Law> none{};
  const LinkGroup<Law>& g = set.groups.empty() ? none : set.groups.front();
  return part(g.end - g.begin, energies_of<Number>(w, set, g), rest);
}
template <class Number, class Law>
void add_further_groups(FoldSum<Energies>& all, const World& w, const LinkSet<Law>& set) {
  for (std::size_t k = 1; k < set.groups.size(); ++k)
    all.add(set.groups[k].end - set.groups[k].begin, energies_of<Number>(w, set, set.groups[k]));
}

/// Energy stored by contacts; `stored_normal` comes from the overlap of the last step.
struct ContactShares {
  ContactLaw law;
  View<const std::int16_t> material;
  View<const ElementState> state_of;
  View<const ContactPair> pairs;
  Index materials;         ///< 0: contacts with walls, one pair a material
  View<const Wall> walls;  ///< empty between elements
  View<const Index> a, b;
  View<const ContactState> state;
  View<const double> slid, damped;
  View<const double> driven;  ///< likewise

  BR_HD void add_to(Energies& s, Index i) const {
    const double overlap = state[i].overlap;
    if (overlap > 0.0) {
      const double ra = state_of[a[i]].radius;
      if (materials > 0) {
        const double rb = state_of[b[i]].radius;
        const ContactLaw::Pair pair{ra * rb / (ra + rb), min(ra, rb), ra + rb, 0.0, 0.0};
        s.elastic.add(
            law.stored_normal(pairs[material[a[i]] * materials + material[b[i]]], pair, overlap));
      } else {
        ContactPair constants = pairs[material[a[i]]];
        const Wall& wall = walls[b[i]];
        if (!law.hertz) constants.normal *= wall.stiffness;
        s.elastic.add(
            law.stored_normal(constants, {wall.curved(ra), ra, 2.0 * ra, 0.0, 0.0}, overlap));
      }
      s.elastic.add(state[i].stored);
    }
    s.friction.add(slid[i]);
    s.contact.add(damped[i]);
    if (driven.size > 0) s.work.add(driven[i]);
  }
};

template <class List, class... Rest>
auto contacts_part(const World& w, const List& c, const Buffer<ContactPair>& pairs, Index materials,
                   const Buffer<Wall>& walls, const Parts<Rest...>& rest) {
  return part(
      c.size(),
      of_owned(w.domain, Energies{},
               ContactShares{w.given->contact, w.elements.material.view(), w.elements.state.view(),
                             pairs.view(), materials, walls.view(), c.pairs.a.view(),
                             c.pairs.b.view(), c.history.state.view(), c.history.slid.view(),
                             c.history.damped.view(), c.history.work_of_walls()},
               ListedElement<>{c.pairs.a.view()}),
      rest);
}

}  // namespace

std::function<Energies()> held_later(const World& w) {
  const StageTime timed(w.exec, "ledger");
  const Elements& e = w.elements;
  FoldSum<Energies> all(w.exec);
  Buffer<Wall> walls(w.exec.space);
  if (!w.walls.empty()) copy_to(walls, w.walls);
  const bool falls = dot(w.given->gravity, w.given->gravity) > 0.0;
  const auto own = [&w](const auto& kernel) { return of_owned(w.domain, Energies{}, kernel); };
  const auto others = part(
      e.size(), own(ByPacks<KineticEnergy>{{kick(w)}, w.lanes}),
      part(e.size(),
           own(ByPacks<ElementShares>{{kick(w), e.damping_work.view(), e.load_work.view()},
                                      w.lanes}),
           part(falls ? e.size() : 0,
                own(GravityPotential{w.given->gravity, e.state.view(), e.mass.view()}),
                contacts_part(
                    w, w.contacts, w.given->contact_pairs, w.given->materials, walls,
                    contacts_part(w, w.wall_contacts, w.given->wall_pairs, 0, walls, Parts<>{})))));
  with_number(w.exec.precision, [&](auto number) {
    using Number = decltype(number);
    all.add_parts(first_group<Number>(
        w, w.concrete,
        first_group<Number>(w, w.steel, first_group<Number>(w, w.interface, others))));
    add_further_groups<Number>(all, w, w.concrete);
    add_further_groups<Number>(all, w, w.steel);
    add_further_groups<Number>(all, w, w.interface);
    for (const auto& g : w.parallel.groups)
      all.add(g.end - g.begin, energies_of<Number>(w, w.parallel, g));
    for (const auto& g : w.ldpm.groups) all.add(g.end - g.begin, energies_of<Number>(w, w.ldpm, g));
  });
  if (w.free_walls.empty()) return all.sum_later();
  return [others = all.sum_later(), walls = held_by_free_walls(w)] { return others() + walls; };
}

EnergyBalance balance(Ledger& ledger, const Energies& all, std::int64_t step) {
  EnergyBalance r;
  r.kinetic = all.kinetic.value();
  r.elastic = all.elastic.value();
  r.fracture = all.fracture.value();
  r.plastic = all.plastic.value();
  r.friction = (all.friction + ledger.friction).value();
  r.contact = (all.contact + ledger.contact).value();
  r.damping = all.damping.value();
  r.work = (all.work + ledger.came_in).value();
  if (step == 0) ledger.start_potential = all.potential;
  r.work += all.potential.value() - ledger.start_potential.value();
  r.start = ledger.start;
  ledger.largest = std::max({ledger.largest, r.kinetic + r.elastic, std::fabs(r.work), r.total()});
  if (step != 0) r.relate_to(ledger.largest);
  return r;
}
EnergyBalance balance(World& w) {
  return balance(w.ledger, held(w), w.step);
}

}  // namespace breccia::dem
