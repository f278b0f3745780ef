// New contacts: the shared search, less the pairs that links join, with the history of those that
// stay.

#include <algorithm>

#include "dem/world.hpp"
#include "exec/for_each.hpp"

namespace breccia::dem {
namespace {

/// How far an element has used its margin up: above 1 the list of pairs is no longer valid.
struct UsedMargin {
  View<const ElementState> state;
  View<const Vec3> reference;
  View<const double> margin;
  BR_HD double operator()(Index e) const {
    const Vec3 moved = state[e].position - reference[e];
    const double allowed = margin[e] * margin[e];
    const double square = dot(moved, moved);
    return square <= allowed ? 0.0 : 1.0;  // NaN counts as beyond
  }
};

struct UnpackState {
  View<const ElementState> state;
  View<Vec3> position, velocity;
  View<double> radius;
  BR_HD void operator()(Index e) const {
    position[e] = state[e].position;
    velocity[e] = state[e].velocity;
    radius[e] = state[e].radius;
  }
};

/// Keys of the links that still hold their pair: all but released ones. Sorted.
Buffer<PairKey> holding_links(const World& w) {
  std::vector<double> concrete;
  std::vector<InterfaceState> interface;
  std::vector<PairKey> keys;
  std::vector<Index> links;
  copy_to(concrete, w.concrete.opening);
  copy_to(interface, w.interface.state);
  copy_to(keys, w.linked);
  copy_to(links, w.linked_links);
  const auto concretes = static_cast<Index>(concrete.size());
  const Index bonds = concretes + w.steel.size();  // first interface link
  const auto released = [&](Index link) {
    double opening = 0.0;
    if (link < concretes) opening = concrete[static_cast<std::size_t>(link)];
    if (link >= bonds) opening = interface[static_cast<std::size_t>(link - bonds)].opening;
    return opening < 0.5 * (link_broken + link_released);
  };
  std::vector<PairKey> holding;
  holding.reserve(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (!released(links[i])) holding.push_back(keys[i]);
  Buffer<PairKey> held(w.exec.space);
  copy_to(held, holding);
  return held;
}

/// Takes away pairs whose boxes overlap but whose grown spheres do not.
void keep_near(World& w, Pairs& pairs) {
  std::vector<PairKey> key, near_key;
  std::vector<Index> a, b, near_a, near_b;
  std::vector<ElementState> state;
  std::vector<double> margin;
  copy_to(key, pairs.key);
  copy_to(a, pairs.a);
  copy_to(b, pairs.b);
  copy_to(state, w.elements.state);
  copy_to(margin, w.travel.margin);
  for (std::size_t i = 0; i < key.size(); ++i) {
    const auto p = static_cast<std::size_t>(a[i]), q = static_cast<std::size_t>(b[i]);
    const Vec3 d = state[q].position - state[p].position;
    const double reach =
        (state[p].radius + state[q].radius + margin[p] + margin[q]) * (1.0 + 1e-12);
    if (dot(d, d) > reach * reach) continue;
    near_key.push_back(key[i]);
    near_a.push_back(a[i]);
    near_b.push_back(b[i]);
  }
  copy_to(pairs.key, near_key);
  copy_to(pairs.a, near_a);
  copy_to(pairs.b, near_b);
}

/// Books what the pairs that leave the list have spent.
void book_dropped(World& w, const Contacts& contacts, const Pairs& found) {
  Buffer<Index> dropped(w.exec.space);
  find_dropped(w.exec, contacts.pairs.key, found.key, dropped);
  if (dropped.empty()) return;
  std::vector<Index> places;
  std::vector<double> slid, damped, driven;
  copy_to(places, dropped);
  copy_to(slid, contacts.history.slid);
  copy_to(damped, contacts.history.damped);
  copy_to(driven, contacts.history.driven);
  for (const Index place : places) {
    const auto i = static_cast<std::size_t>(place);
    w.ledger.slid.add(slid[i]);
    w.ledger.damped.add(damped[i]);
    w.ledger.driven.add(driven[i]);
  }
}

/// Elements whose grown sphere reaches a wall, by wall, then by global id.
Pairs near_walls(const World& w) {
  Buffer<ElementState> state;
  Buffer<double> margin;
  Buffer<GlobalId> id;
  copy_to(state, w.elements.state);
  copy_to(margin, w.travel.margin);
  copy_to(id, w.elements.id);
  std::vector<PairKey> key;
  std::vector<Index> a, b;
  for (std::size_t k = 0; k < w.walls.size(); ++k) {
    const Wall& wall = w.walls[k];
    // A moving wall uses margins up, too: it may cover one largest margin until it asks for a
    // search.
    const double reach =
        dot(wall.velocity, wall.velocity) > 0.0 ? w.parameters.largest_margin : 0.0;
    std::vector<std::pair<PairKey, Index>> near;
    for (Index e = 0; e < state.size(); ++e) {
      const ElementState& s = state.data()[e];
      if (dot(s.position - wall.point, wall.normal) <= s.radius + margin.data()[e] + reach)
        near.emplace_back(
            (static_cast<PairKey>(k) << 32) | static_cast<std::uint32_t>(id.data()[e]), e);
    }
    std::sort(near.begin(), near.end());
    for (const auto& [pair, element] : near) {
      key.push_back(pair);
      a.push_back(element);
      b.push_back(static_cast<Index>(k));
    }
  }
  Pairs pairs(w.exec.space);
  copy_to(pairs.key, key);
  copy_to(pairs.a, a);
  copy_to(pairs.b, b);
  return pairs;
}

void find_wall_contacts(World& w) {
  if (w.walls.empty()) return;
  Pairs near = near_walls(w);
  book_dropped(w, w.wall_contacts, near);
  w.wall_contacts.replace(w.exec, std::move(near));
  for (Wall& wall : w.walls) wall.travelled = 0.0;
}

/// First contact of each wall, and the end.
void divide_by_wall(World& w) {
  std::vector<Index> wall_of;
  copy_to(wall_of, w.wall_contacts.pairs.b);
  w.wall_begin.assign(w.walls.size() + 1, static_cast<Index>(wall_of.size()));
  for (std::size_t k = 0; k < w.walls.size(); ++k)
    w.wall_begin[k] = static_cast<Index>(
        std::lower_bound(wall_of.begin(), wall_of.end(), static_cast<Index>(k)) - wall_of.begin());
}

/// First link of each element among a group's links, which are sorted by a.
void find_starts(const std::vector<Index>& a, Index elements, LinkGroup<ConcreteLink>& group) {
  group.starts.assign(static_cast<std::size_t>(elements) + 1, group.end);
  Index element = 0;
  for (Index i = group.begin; i < group.end; ++i)
    for (; element <= a[static_cast<std::size_t>(i)]; ++element)
      group.starts[static_cast<std::size_t>(element)] = i;
}

/// Runs of elements with about as many links each.
void plan_sweep(World& w) {
  std::vector<Index> a, b;
  copy_to(a, w.concrete.a);
  copy_to(b, w.concrete.b);
  const Index count = w.elements.size();
  std::vector<Index> links_before(static_cast<std::size_t>(count) + 1, 0);
  std::vector<Index> reached(static_cast<std::size_t>(count) + 1,
                             0);  // by links of elements before
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto next = static_cast<std::size_t>(a[i]) + 1;
    ++links_before[next];
    reached[next] = std::max(reached[next], b[i] + 1);
  }
  for (std::size_t e = 1; e < links_before.size(); ++e) {
    links_before[e] += links_before[e - 1] + 1;  // an element weighs about as much as a link
    reached[e] = std::max(reached[e], reached[e - 1]);
  }
  for (auto& group : w.concrete_groups) find_starts(a, count, group);
  const int threads = count < smallest_shared_loop ? 1 : w.exec.threads;
  w.sweep = {};
  for (int t = 0; t <= threads; ++t) {
    const auto share =
        static_cast<Index>(static_cast<std::int64_t>(links_before.back()) * t / threads);
    const auto begin = static_cast<Index>(
        std::lower_bound(links_before.begin(), links_before.end(), share) - links_before.begin());
    w.sweep.begin.push_back(std::min(begin / sweep_tile * sweep_tile, count));
  }
  w.sweep.begin.back() = count;
  for (int t = 0; t < threads; ++t) {
    const Index begin = w.sweep.begin[static_cast<std::size_t>(t)];
    w.sweep.settled.push_back(std::max(begin, reached[static_cast<std::size_t>(begin)]));
  }
  for (std::size_t i = 0; i < a.size(); ++i) w.sweep.reach = std::max(w.sweep.reach, b[i] - a[i]);
  w.sweep.passed.resize(static_cast<std::size_t>(threads));
}

}  // namespace

bool contacts_are_due(const World& w) {
  const StageTime timed(w.exec, "travel");
  if (w.parameters.search.every > 0)  // the paper's rule
    return w.step % w.parameters.search.every == 0;
  for (const Wall& wall : w.walls)
    if (wall.travelled > w.parameters.largest_margin) return true;
  return fold(
             w.exec, w.elements.size(), 0.0,
             UsedMargin{w.elements.state.view(), w.travel.reference.view(), w.travel.margin.view()},
             [](double a, double b) { return larger(a, b); }) > 0.0;
}

void find_contacts(World& w) {
  const StageTime timed(w.exec, "contact_detection");
  const Index count = w.elements.size();
  Buffer<Vec3> position(w.exec.space, count), velocity(w.exec.space, count);
  Buffer<double> radius(w.exec.space, count);
  for_each(w.exec, count,
           UnpackState{std::as_const(w.elements.state).view(), position.view(), velocity.view(),
                       radius.view()});
  constexpr double horizon = 30.0;  // steps for which a fast element's margin shall last
  const MarginRule rule{w.parameters.search.margin * w.parameters.mean_radius, horizon * w.next_dt,
                        w.parameters.largest_margin};
  begin_travel(w.exec, rule, position, velocity, w.travel);
  Buffer<Box> boxes(w.exec.space);
  sphere_boxes(w.exec, position, radius, w.travel.margin, boxes);
  Pairs found(w.exec.space);
  w.broad_phase.search(w.exec, boxes, w.elements.id, found);
  exclude_pairs(w.exec, found, holding_links(w));
  keep_near(w, found);
  book_dropped(w, w.contacts, found);
  w.contacts.replace(w.exec, std::move(found));
  find_wall_contacts(w);
  derive_contacts(w);
  ++w.searches;
}

void derive_contacts(World& w) {
  build_incidence(w.exec, w.contacts.pairs.a, w.contacts.pairs.b, w.elements.id,
                  w.contact_incidence);
  w.contact_actions.clear();
  w.contact_actions.resize(w.contacts.size());  // all zero: ContactForces writes what touches
  divide_by_wall(w);
}

void derive(World& w) {
  std::vector<Index> a, b, more;
  const auto append = [&](std::vector<Index>& all, const Buffer<Index>& ends) {
    copy_to(more, ends);
    all.insert(all.end(), more.begin(), more.end());
  };
  append(a, w.steel.a);
  append(a, w.interface.a);
  append(b, w.steel.b);
  append(b, w.interface.b);
  Buffer<Index> all_a(w.exec.space), all_b(w.exec.space);
  copy_to(all_a, a);
  copy_to(all_b, b);
  build_incidence(w.exec, all_a, all_b, w.elements.id, w.bar_incidence);
  w.bar_actions.resize(all_a.size());
  w.link_sums.resize(w.elements.size());
  w.critical.resize(w.elements.size());
  plan_sweep(w);
  derive_contacts(w);
}

}  // namespace breccia::dem
