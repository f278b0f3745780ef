#include "dem/setup/link_sets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/rows.hpp"
#include "dem/setup/materials.hpp"
#include "exec/error.hpp"
#include "exec/filling.hpp"
#include "math/constants.hpp"

namespace breccia::dem {
namespace {

/// Distinguishes links that no law serves together.
using LawKey = std::tuple<std::int16_t, double, double, double>;

/// The laws that some links have, ascending.
template <class LawOf>
std::vector<LawKey> distinct(int threads, Index count, const LawOf& law_of) {
  std::vector<LawKey> all;
  const auto add = [](std::vector<LawKey>& to, const LawKey& key) {
    const auto place = std::lower_bound(to.begin(), to.end(), key);
    if (place == to.end() || *place != key) to.insert(place, key);
  };
  for (const auto& run : of_runs(threads, count, [&](Index begin, Index end) {
         std::vector<LawKey> found;
         LawKey last;
         for (Index i = begin; i < end; ++i) {
           const LawKey key = law_of(i);
           if (i > begin && key == last) continue;
           add(found, key);
           last = key;
         }
         return found;
       }))
    for (const LawKey& key : run.found) add(all, key);
  return all;
}

/// The links of a model that one set gets, in its order.
class LinksOf {
 public:
  LinksOf(const Model& m, LinkKind kind, int threads)
      : model_(&m),
        threads_(threads),
        places_(numbers_where(threads, static_cast<Index>(m.links.size()),
                              [&](Index i) { return m.links[at(i)].kind == kind; })) {}

  Index size() const { return places_.size(); }
  int threads() const { return threads_; }
  const Model::Link& operator[](Index i) const { return model_->links[at(places_.data()[i])]; }

  LawKey law_of(Index i) const {
    const Model::Link& link = (*this)[i];
    if (link.kind != LinkKind::concrete || model_->bulk.empty())
      return {link.material, 1.0, 0.0, link.strength};
    const Model::Bulk& bulk = model_->bulk[at(model_->group[at(link.a)])];
    return {link.material, bulk.factor, bulk.rupture_opening, link.strength};
  }

  /// Sorts by law, links of one law in the model's order. Returns where each law's links end.
  std::vector<Index> sort_by_law() {
    const std::vector<LawKey> laws =
        distinct(threads_, size(), [this](Index i) { return law_of(i); });
    if (laws.size() < 2) return {size()};
    struct Run {
      Index begin = 0, end = 0;
      std::vector<Index> counts;  ///< of each law, then where its next link goes
    };
    const auto number_of = [&](Index i) {
      return static_cast<std::size_t>(std::lower_bound(laws.begin(), laws.end(), law_of(i)) -
                                      laws.begin());
    };
    auto runs = of_runs(threads_, size(), [&](Index begin, Index end) {
      Run run{begin, end, std::vector<Index>(laws.size(), 0)};
      for (Index i = begin; i < end; ++i) ++run.counts[number_of(i)];
      return run;
    });
    std::vector<Index> ends;
    Index place = 0;
    for (std::size_t law = 0; law < laws.size(); ++law) {
      for (auto& run : runs) place += std::exchange(run.found.counts[law], place);
      ends.push_back(place);
    }
    Buffer<Index> sorted = unfilled<Index>(Space::host, size());
    for_each_task(threads_, static_cast<int>(runs.size()), [&](int k) {
      Run& run = runs[static_cast<std::size_t>(k)].found;
      for (Index i = run.begin; i < run.end; ++i)
        sorted.data()[run.counts[number_of(i)]++] = places_.data()[i];
    });
    places_ = std::move(sorted);
    return ends;
  }

 private:
  const Model* model_;
  int threads_;
  Buffer<Index> places_;
};

/// The links of one kind, sorted into groups of one material and, of concrete, bodies of one bulk
/// and links of one strength, each in the model's order.
template <class Law, class MakeLaw>
LinksOf grouped(const Model& m, const Config& config, int threads, LinkSet<Law>& set,
                const MakeLaw& make_law) {
  LinksOf links(m, set.kind, threads);
  Index begin = 0;
  for (const Index end : links.sort_by_law()) {
    if (end == begin) continue;  // no link at all
    const std::int16_t material = links[begin].material;
    set.groups.push_back(
        {make_law(config.materials.at(at(material)), links[begin]), begin, end, material});
    begin = end;
  }
  fill_items(set.seen_broken, links.size(), threads, [](Index) { return -1.0; });
  return links;
}

/// An array with one item a link: item(link).
template <class T, class Item>
void fill_links(Buffer<T>& to, const LinksOf& links, const Item& item) {
  fill_items(to, links.size(), links.threads(), [&](Index i) -> T { return item(links[i]); });
}

double distance(const Model& m, Index a, Index b) {
  return norm(m.position[static_cast<std::size_t>(b)] - m.position[static_cast<std::size_t>(a)]);
}
double radius_of(const Model& m, Index e) {
  return m.radius[static_cast<std::size_t>(e)];
}

void set_ends(Buffer<Index>& a, Buffer<Index>& b, const LinksOf& links) {
  fill_links(a, links, [](const Model::Link& link) { return link.a; });
  fill_links(b, links, [](const Model::Link& link) { return link.b; });
}

/// A law whose stresses all are so many times larger.
void weaken(ConcreteLink& law, double by) {
  for (double* stress : {&law.tensile_strength, &law.cohesion, &law.friction_cap, &law.rolling_cap,
                         &law.compaction_strength, &law.crushing_strength})
    *stress *= by;
}

void set_links(LinkSet<ConcreteLink>& set, const Config& config, const Model& m, int threads) {
  for (const MaterialConfig& c : config.materials) {
    if (c.law != "concrete") continue;
    set.rated = set.rated || c.rate != "none";
    set.damped = set.damped || c.link_damping > 0.0;
  }
  // place_arrays() left them out
  if (set.rated) move_array(set.rate, set.length.space());
  if (set.damped) {
    move_array(set.branch_normal, set.length.space());
    move_array(set.branch_shear, set.length.space());
    move_array(set.damped_away, set.length.space());
  }
  const LinksOf links =
      grouped(m, config, threads, set, [&](const MaterialConfig& c, const Model::Link& link) {
        ConcreteLink law = concrete_law(c, config.contact);
        law.modulus *= m.bulk_of(link.a).factor;
        law.rupture_opening = m.bulk_of(link.a).rupture_opening;
        if (link.strength != 1.0) weaken(law, link.strength);
        return law;
      });
  for (LinkGroup<ConcreteLink>& group : set.groups) {
    group.bulk = m.bulk_of(links[group.begin].a).factor;
    group.strength = links[group.begin].strength;
  }
  set_ends(set.a, set.b, links);
  const auto material = [&](const Model::Link& link) -> const MaterialConfig& {
    return config.materials[at(link.material)];
  };
  fill_links(set.length, links,
             [&](const Model::Link& link) { return distance(m, link.a, link.b); });
  fill_links(set.stiffness, links,
             [&](const Model::Link& link) { return link_stiffness(m, link, material(link)); });
  fill_links(set.area, links, [&](const Model::Link& link) {
    return bedding_share(m, link, material(link)).strength * link_section(m, link);
  });
  with_number(set.precision, [&](auto number) {
    fill_links(set.kept.as<decltype(number)>().opening, links, [](const Model::Link& link) {
      return static_cast<decltype(number)>(link.parted ? link_broken : 0.0);
    });
  });
}

void set_links(LinkSet<ParallelBond>& set, const Config& config, const Model& m, int threads) {
  const LinksOf links =
      grouped(m, config, threads, set, [&](const MaterialConfig& c, const Model::Link&) {
        return parallel_bond(c, config.contact);
      });
  set_ends(set.a, set.b, links);
  const auto material = [&](const Model::Link& link) -> const MaterialConfig& {
    return config.materials[at(link.material)];
  };
  fill_links(set.length, links,
             [&](const Model::Link& link) { return distance(m, link.a, link.b); });
  fill_links(set.stiffness, links, [&](const Model::Link& link) {
    const double radius =
        material(link).bond_radius * std::min(radius_of(m, link.a), radius_of(m, link.b));
    return bedding_share(m, link, material(link)).stiffness *
           (local_elasticity(material(link)).modulus * pi * radius * radius /
            distance(m, link.a, link.b));
  });
  fill_links(set.strength, links, [&](const Model::Link& link) {
    return bedding_share(m, link, material(link)).strength;
  });
  fill_links(set.state, links, [](const Model::Link& link) {
    return ParallelBondState{link.parted ? 0.0 : 1.0, 0.0, {}, {}};
  });
}

/// Some unit vector across another.
Vec3 across(const Vec3& n) {
  const Vec3 size{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
  const Vec3 axis = size.x <= size.y && size.x <= size.z ? Vec3{1.0, 0.0, 0.0}
                    : size.y <= size.z                   ? Vec3{0.0, 1.0, 0.0}
                                                         : Vec3{0.0, 0.0, 1.0};
  const Vec3 m = axis - dot(axis, n) * n;
  return (1.0 / norm(m)) * m;
}

void set_links(LinkSet<LdpmFacet>& set, const Config& config, const Model& m, int threads) {
  const LinksOf links =
      grouped(m, config, threads, set,
              [](const MaterialConfig& c, const Model::Link&) { return ldpm_facet(c); });
  set_ends(set.a, set.b, links);
  const auto facet_of = [&m](const Model::Link& link) -> const Model::Facet& {
    return m.facets.at(at(link.facet));
  };
  const auto x = [&m](Index e) { return m.position[at(e)]; };
  fill_links(set.c, links, [&](const Model::Link& link) { return facet_of(link).c; });
  fill_links(set.d, links, [&](const Model::Link& link) { return facet_of(link).d; });
  fill_links(set.place, links, [&](const Model::Link& link) {
    const Model::Facet& facet = facet_of(link);
    const Vec3 along = x(link.b) - x(link.a), from_a = facet.center - x(link.a);
    const double length = norm(along);
    const Vec3 n = (1.0 / length) * along, first = across(n);
    return LdpmPlace{length,
                     facet.area,
                     {dot(from_a, n), dot(from_a, first), dot(from_a, cross(n, first))},
                     six_volumes(x(link.a), x(link.b), x(facet.c), x(facet.d))};
  });
  fill_links(set.frame, links, [&](const Model::Link& link) {
    const Vec3 along = x(link.b) - x(link.a);
    return LdpmFrame{across((1.0 / norm(along)) * along), 1.0};
  });
}

void set_links(LinkSet<SteelLink>& set, const Config& config, const Model& m, int threads) {
  const LinksOf links =
      grouped(m, config, threads, set,
              [](const MaterialConfig& c, const Model::Link&) { return steel_law(c); });
  set_ends(set.a, set.b, links);
  fill_links(set.length, links,
             [&](const Model::Link& link) { return distance(m, link.a, link.b); });
}

bool is_steel(const Config& config, const Model& m, Index e) {
  const auto material = static_cast<std::size_t>(m.material[static_cast<std::size_t>(e)]);
  return config.materials[material].law == "steel";
}

void set_links(LinkSet<InterfaceLink>& set, const Config& config, const Model& m, int threads) {
  const LinksOf links =
      grouped(m, config, threads, set, [&](const MaterialConfig& c, const Model::Link&) {
        return interface_law(c, config.contact);
      });
  const auto bar_of = [&](const Model::Link& link) {
    return is_steel(config, m, link.a) ? link.a : link.b;
  };
  const auto other_of = [&](const Model::Link& link) {
    return is_steel(config, m, link.a) ? link.b : link.a;
  };
  fill_links(set.a, links, bar_of);
  fill_links(set.b, links, other_of);
  Buffer<Index> shares(Space::host, links.size() > 0 ? m.size() : 0);  // links of each bar element
  each_portion(threads, links.size(), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) count_up(shares.data()[bar_of(links[i])]);
  });
  const auto lone = numbers_where(threads, links.size(), [&](Index i) {
    const Index s = bar_of(links[i]);
    return m.bar_previous[at(s)] < 0 && m.bar_next[at(s)] < 0;
  });
  if (!lone.empty())
    throw InputError(fmt::format("element {} is bonded as a bar but has no neighbour along it",
                                 bar_of(links[lone.host().front()])));
  const auto neighbour = [](const PlainVector<Index>& along, Index s) {
    return along[at(s)] >= 0 ? along[at(s)] : s;
  };
  const auto share_of = [&](const Model::Link& link) {  // pi d_b L_s / n_s
    const Index s = bar_of(link), previous = m.bar_previous[at(s)], next = m.bar_next[at(s)];
    const double piece = 0.5 * ((previous >= 0 ? distance(m, s, previous) : 0.0) +
                                (next >= 0 ? distance(m, s, next) : 0.0));
    return pi * 2.0 * m.radius[at(s)] * piece / shares.data()[s];
  };
  fill_links(set.before, links,
             [&](const Model::Link& link) { return neighbour(m.bar_previous, bar_of(link)); });
  fill_links(set.after, links,
             [&](const Model::Link& link) { return neighbour(m.bar_next, bar_of(link)); });
  fill_links(set.area, links, share_of);
  fill_links(set.stiffness, links, [&](const Model::Link& link) {
    const Index s = bar_of(link), c = other_of(link);
    const double layer = std::max(distance(m, s, c), 0.5 * (radius_of(m, s) + radius_of(m, c)));
    return config.materials[at(m.material[at(c)])].young * share_of(link) / layer;
  });
}

}  // namespace

void set_links(World& w, const Config& config, const Model& model) {
  w.each_set([&](auto& set) {
    set_links(set, config, model, w.exec.threads);
    resize_fields(set, set.a.size());  // the others are zero
  });
}

}  // namespace breccia::dem
