#include "dem/setup/link_sets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>

#include "dem/setup/materials.hpp"
#include "exec/error.hpp"
#include "math/constants.hpp"

namespace breccia::dem {
namespace {

/// The links of one kind, sorted into groups of one material and, of concrete, bodies of one bulk
/// and links of one strength, each in the model's order.
template <class Law, class MakeLaw>
std::vector<Model::Link> grouped(const Model& m, const Config& config, LinkSet<Law>& set,
                                 const MakeLaw& make_law) {
  std::vector<LinkGroup<Law>>& groups = set.groups;
  const auto is_here = [&](const Model::Link& link) { return link.kind == set.kind; };
  std::vector<Model::Link> links;  // grown by halves it would be copied, and its pages cleared anew
  links.reserve(static_cast<std::size_t>(std::count_if(m.links.begin(), m.links.end(), is_here)));
  std::copy_if(m.links.begin(), m.links.end(), std::back_inserter(links), is_here);
  const auto law_of = [&](const Model::Link& link) {
    const Model::Bulk bulk = link.kind == LinkKind::concrete ? m.bulk_of(link.a) : Model::Bulk{};
    return std::tuple{link.material, bulk.factor, bulk.rupture_opening, link.strength};
  };
  const auto before = [&](const Model::Link& p, const Model::Link& q) {
    return law_of(p) < law_of(q);
  };
  if (!std::is_sorted(links.begin(), links.end(), before))
    std::stable_sort(links.begin(), links.end(), before);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const std::int16_t material = links[i].material;
    const auto first = static_cast<Index>(i);
    if (i == 0 || law_of(links[i - 1]) != law_of(links[i]))
      groups.push_back(
          {make_law(config.materials.at(at(material)), links[i]), first, first, material, {}});
    groups.back().end = static_cast<Index>(i + 1);
  }
  resize_fields(set, static_cast<Index>(links.size()));
  copy_to(set.seen_broken, std::vector<double>(links.size(), -1.0));
  return links;
}

double distance(const Model& m, Index a, Index b) {
  return norm(m.position[static_cast<std::size_t>(b)] - m.position[static_cast<std::size_t>(a)]);
}
double radius_of(const Model& m, Index e) {
  return m.radius[static_cast<std::size_t>(e)];
}

void set_ends(Buffer<Index>& a, Buffer<Index>& b, const std::vector<Model::Link>& links) {
  std::vector<Index> first(links.size()), second(links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    first[i] = links[i].a;
    second[i] = links[i].b;
  }
  copy_to(a, first);
  copy_to(b, second);
}

/// A law whose stresses all are so many times larger.
void weaken(ConcreteLink& law, double by) {
  for (double* stress : {&law.tensile_strength, &law.cohesion, &law.friction_cap, &law.rolling_cap,
                         &law.compaction_strength, &law.crushing_strength})
    *stress *= by;
}

void set_links(LinkSet<ConcreteLink>& set, const Config& config, const Model& m) {
  for (const MaterialConfig& c : config.materials)
    set.rated = set.rated || (c.law == "concrete" && c.rate != "none");
  if (set.rated) move_array(set.rate, set.length.space());  // place_arrays() left it out
  const auto links = grouped(m, config, set, [&](const MaterialConfig& c, const Model::Link& link) {
    ConcreteLink law = concrete_law(c, config.contact);
    law.modulus *= m.bulk_of(link.a).factor;
    law.rupture_opening = m.bulk_of(link.a).rupture_opening;
    if (link.strength != 1.0) weaken(law, link.strength);
    return law;
  });
  for (LinkGroup<ConcreteLink>& group : set.groups) {
    group.bulk = m.bulk_of(links[at(group.begin)].a).factor;
    group.strength = links[at(group.begin)].strength;
  }
  set_ends(set.a, set.b, links);
  std::vector<double> length(links.size()), stiffness(links.size()), area(links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Model::Link& link = links[i];
    length[i] = distance(m, link.a, link.b);
    const MaterialConfig& material = config.materials[at(link.material)];
    area[i] = bedding_share(m, link, material).strength * link_section(m, link);
    stiffness[i] = link_stiffness(m, link, material);
  }
  copy_to(set.length, length);
  copy_to(set.stiffness, stiffness);
  copy_to(set.area, area);
  with_number(set.precision, [&](auto number) {
    std::vector<decltype(number)> opening(links.size());
    for (std::size_t i = 0; i < links.size(); ++i)
      opening[i] = static_cast<decltype(number)>(links[i].parted ? link_broken : 0.0);
    copy_to(set.kept.as<decltype(number)>().opening, opening);
  });
}

void set_links(LinkSet<ParallelBond>& set, const Config& config, const Model& m) {
  const auto links = grouped(m, config, set, [&](const MaterialConfig& c, const Model::Link&) {
    return parallel_bond(c, config.contact);
  });
  set_ends(set.a, set.b, links);
  std::vector<double> length, stiffness, strength;
  for (const Model::Link& link : links) {
    const double d = distance(m, link.a, link.b);
    const MaterialConfig& material = config.materials[at(link.material)];
    const double radius =
        material.bond_radius * std::min(radius_of(m, link.a), radius_of(m, link.b));
    length.push_back(d);
    const BeddingShare share = bedding_share(m, link, material);
    stiffness.push_back(share.stiffness *
                        (local_elasticity(material).modulus * pi * radius * radius / d));
    strength.push_back(share.strength);
  }
  copy_to(set.length, length);
  copy_to(set.stiffness, stiffness);
  copy_to(set.strength, strength);
  std::vector<ParallelBondState> state;
  for (const Model::Link& link : links) state.push_back({link.parted ? 0.0 : 1.0, 0.0, {}, {}});
  copy_to(set.state, state);
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

void set_links(LinkSet<LdpmFacet>& set, const Config& config, const Model& m) {
  const auto links = grouped(
      m, config, set, [](const MaterialConfig& c, const Model::Link&) { return ldpm_facet(c); });
  set_ends(set.a, set.b, links);
  std::vector<Index> c, d;
  std::vector<LdpmPlace> places;
  std::vector<LdpmFrame> frames;
  for (const Model::Link& link : links) {
    const Model::Facet& facet = m.facets.at(at(link.facet));
    const auto x = [&m](Index e) { return m.position[at(e)]; };
    const Vec3 along = x(link.b) - x(link.a), from_a = facet.center - x(link.a);
    const double length = norm(along);
    const Vec3 n = (1.0 / length) * along, first = across(n);
    c.push_back(facet.c);
    d.push_back(facet.d);
    places.push_back({length,
                      facet.area,
                      {dot(from_a, n), dot(from_a, first), dot(from_a, cross(n, first))},
                      six_volumes(x(link.a), x(link.b), x(facet.c), x(facet.d))});
    frames.push_back({first, 1.0});
  }
  copy_to(set.c, c);
  copy_to(set.d, d);
  copy_to(set.place, places);
  copy_to(set.frame, frames);
}

void set_links(LinkSet<SteelLink>& set, const Config& config, const Model& m) {
  const auto links = grouped(
      m, config, set, [](const MaterialConfig& c, const Model::Link&) { return steel_law(c); });
  set_ends(set.a, set.b, links);
  std::vector<double> length;
  for (const Model::Link& link : links) length.push_back(distance(m, link.a, link.b));
  copy_to(set.length, length);
}

bool is_steel(const Config& config, const Model& m, Index e) {
  const auto material = static_cast<std::size_t>(m.material[static_cast<std::size_t>(e)]);
  return config.materials[material].law == "steel";
}

void set_links(LinkSet<InterfaceLink>& set, const Config& config, const Model& m) {
  auto links = grouped(m, config, set, [&](const MaterialConfig& c, const Model::Link&) {
    return interface_law(c, config.contact);
  });
  std::map<Index, int> shares;  // links of each bar element
  for (Model::Link& link : links) {
    if (!is_steel(config, m, link.a)) std::swap(link.a, link.b);
    ++shares[link.a];
  }
  set_ends(set.a, set.b, links);
  std::vector<Index> before, after;
  std::vector<double> stiffness, area;
  for (const Model::Link& link : links) {
    const auto s = static_cast<std::size_t>(link.a);
    const Index previous = m.bar_previous[s], next = m.bar_next[s];
    if (previous < 0 && next < 0)
      throw InputError(
          fmt::format("element {} is bonded as a bar but has no neighbour along it", s));
    before.push_back(previous >= 0 ? previous : link.a);
    after.push_back(next >= 0 ? next : link.a);
    const double piece = 0.5 * ((previous >= 0 ? distance(m, link.a, previous) : 0.0) +
                                (next >= 0 ? distance(m, link.a, next) : 0.0));
    const double share = pi * 2.0 * m.radius[s] * piece / shares[link.a];  // pi d_b L_s / n_s
    const double d = distance(m, link.a, link.b);
    const double layer = std::max(d, 0.5 * (m.radius[s] + radius_of(m, link.b)));
    const auto concrete = static_cast<std::size_t>(m.material[static_cast<std::size_t>(link.b)]);
    area.push_back(share);
    stiffness.push_back(config.materials[concrete].young * share / layer);
  }
  copy_to(set.before, before);
  copy_to(set.after, after);
  copy_to(set.stiffness, stiffness);
  copy_to(set.area, area);
}

}  // namespace

void set_links(World& w, const Config& config, const Model& model) {
  w.each_set([&](auto& set) { set_links(set, config, model); });
}

}  // namespace breccia::dem
