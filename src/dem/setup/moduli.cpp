#include "dem/setup/moduli.hpp"

#include <algorithm>
#include <type_traits>

#include "core/on_host.hpp"
#include "dem/setup/change_array.hpp"
#include "dem/setup/materials.hpp"
#include "dem/world.hpp"

namespace breccia::dem {
namespace {

/// Values of links begin to end - 1; of `planes` of one component after the other.
template <class Array>
void scale_links(Array& array, Index begin, Index end, double by, Index planes = 1) {
  change_array(array, [&](auto& values) {
    const std::size_t stride = values.size() / static_cast<std::size_t>(planes);
    for (std::size_t from = 0; from < values.size(); from += std::max<std::size_t>(stride, 1))
      for (Index i = begin; i < end; ++i) {
        auto& value = values[from + static_cast<std::size_t>(i)];
        value = static_cast<std::remove_reference_t<decltype(value)>>(by * value);
      }
  });
}

const MaterialConfig& material_of(const Config& config, std::int16_t number) {
  return config.materials[static_cast<std::size_t>(number)];
}

/// The opening at which a branch has a damage between 0 and 1: it grows between onset and rupture.
double opening_with(const TensionSoftening<double>& branch, double damage) {
  double low = branch.onset(), high = branch.rupture();
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (branch.damage(middle) < damage ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// The largest opening of a link with another stiffness: of whole links, and where the branch grows
/// with the onset, with the same force on the envelope; of others with the same damage.
double kept_opening(const ConcreteLink& law, const ConcreteLinks& on_host, Index i, double opening,
                    double by) {
  LinkConstants<double> link = on_host.constants(law, i, opening, 0.0);
  const TensionSoftening<double> was = law.tension(link);
  if (was.whole(opening) || !was.ends_given) return opening / by;
  const double damage = was.damage(opening);
  link.stiffness *= by;
  return damage > 0.0 ? opening_with(law.tension(link), damage) : opening / by;
}

void stiffen(LinkSet<ConcreteLink>& set, const LinkGroup<ConcreteLink>& g, double by) {
  const ConcreteLinks on_host = host_copy(set.arrays());
  with_number(set.precision, [&](auto number) {
    using Number = decltype(number);
    auto& kept = set.kept.as<Number>();
    change_array(kept.opening, [&](std::vector<Number>& opening) {
      for (Index i = g.begin; i < g.end; ++i) {
        Number& own = opening[static_cast<std::size_t>(i)];
        if (own >= Number{}) own = static_cast<Number>(kept_opening(g.law, on_host, i, own, by));
      }
    });
    for (auto* force : {&kept.shear, &kept.moment})
      scale_links(force->items(), g.begin, g.end, by, 3);
  });
  scale_links(set.stiffness, g.begin, g.end, by);
}

void stiffen(LinkSet<ParallelBond>& set, const LinkGroup<ParallelBond>& g, double by) {
  change_array(set.state, [&](std::vector<ParallelBondState>& state) {
    for (Index i = g.begin; i < g.end; ++i) {
      ParallelBondState& own = state[static_cast<std::size_t>(i)];
      own.shear = by * own.shear;
      own.moment = by * own.moment;
    }
  });
  scale_links(set.stiffness, g.begin, g.end, by);
}

template <class Law>
void stiffen_groups(LinkSet<Law>& set, const Config& before, const Config& after) {
  for (const LinkGroup<Law>& g : set.groups) {
    if (g.end > set.size()) continue;  // another rank has all of them
    const double was = material_of(before, g.material).young,
                 is = material_of(after, g.material).young;
    if (was != is) stiffen(set, g, is / was);
  }
}

/// Tangential stiffness of a pair, with which friction and rolling of its contacts grow.
double tangential(const ContactConfig& law, const ContactPair& pair) {
  return law.law == "hertz" ? pair.shear : pair.shear * pair.normal;
}

template <class List, class Pair>
void change_contacts(World& w, List& list, const Pair& pair_in, const Config& before,
                     const Config& after) {
  std::vector<Index> a, b;
  std::vector<std::int16_t> material;
  copy_to(a, list.pairs.a);
  copy_to(b, list.pairs.b);
  copy_to(material, w.elements.material);
  change_array(list.history.state, [&](std::vector<ContactState>& state) {
    for (std::size_t k = 0; k < state.size(); ++k) {
      const double was = tangential(before.contact, pair_in(before, material, a[k], b[k])),
                   is = tangential(after.contact, pair_in(after, material, a[k], b[k]));
      if (was == is || !(was > 0.0)) continue;
      const double by = is / was;
      state[k].shear = by * state[k].shear;
      state[k].moment = by * state[k].moment;
      state[k].stored *= by;
    }
  });
}

}  // namespace

bool changes_moduli(const StageConfig& stage) {
  return std::any_of(stage.materials.begin(), stage.materials.end(),
                     [](const MaterialChange& change) { return change.young >= 0.0; });
}

void change_moduli(World& w, const Config& before, const Config& after) {
  const auto same = [](const MaterialConfig& p, const MaterialConfig& q) {
    return p.young == q.young;
  };
  if (std::equal(before.materials.begin(), before.materials.end(), after.materials.begin(), same))
    return;
  stiffen_groups(w.concrete, before, after);
  stiffen_groups(w.parallel, before, after);
  const auto of = [](const std::vector<std::int16_t>& material, Index e) {
    return material[static_cast<std::size_t>(e)];
  };
  change_contacts(
      w, w.contacts,
      [&](const Config& c, const std::vector<std::int16_t>& material, Index a, Index b) {
        return contact_pair(c.contact, material_of(c, of(material, a)),
                            material_of(c, of(material, b)));
      },
      before, after);
  change_contacts(
      w, w.wall_contacts,
      [&](const Config& c, const std::vector<std::int16_t>& material, Index a, Index) {
        return wall_pair(c.contact, material_of(c, of(material, a)));
      },
      before, after);
}

}  // namespace breccia::dem
