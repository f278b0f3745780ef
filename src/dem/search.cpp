// New contacts: the shared search, less the pairs that links join, with the history of those that
// stay.

#include <algorithm>
#include <utility>

#include "core/rows.hpp"
#include "core/select.hpp"
#include "dem/free_walls.hpp"
#include "dem/near.hpp"
#include "dem/ranks.hpp"
#include "dem/wall_key.hpp"
#include "domain/drift.hpp"
#include "domain/owned.hpp"
#include "exec/filling.hpp"

namespace breccia::dem {
namespace {

/// Positions, and velocities less that of the drift.
struct UnpackState {
  Vec3 drift;  ///<  [m/s]
  View<const ElementState> state;
  View<Vec3> position, velocity;
  View<double> radius;
  BR_HD void operator()(Index e) const {
    position[e] = state[e].position;
    velocity[e] = state[e].velocity - drift;
    radius[e] = state[e].radius;
  }
};

/// Pairs that a link of one kind still holds: all but released ones do.
template <class Released>
struct ListHeld {
  static constexpr const char* name = "dem.list_held";
  Released released;
  Index first, count;                 ///< of the kind among the links of all kinds
  View<const Index> links, partners;  ///< by the ends of the link
  View<Index> held;
  BR_HD void operator()(Index i) const {
    const Index link = links[i] - first;
    if (link >= 0 && link < count) held[i] = released(link) ? -1 : partners[i];
  }
};

/// The links that a search leaves out.
KnownPairs held_pairs(World& w) {
  w.held_partners.resize_unfilled(w.linked_partners.size());
  Index first = 0;
  w.each_set([&](const auto& set) {
    with_number(w.exec.precision, [&](auto number) {
      const auto released = set.template released<decltype(number)>();
      if (set.size() > 0)
        for_each(w.exec, w.linked_partners.size(),
                 ListHeld<decltype(released)>{released, first, set.size(), w.linked_links.view(),
                                              w.linked_partners.view(), w.held_partners.view()});
    });
    first += set.size();
  });
  return {w.linked_starts.view(), w.held_partners.view()};
}

/// Whether a pair may touch: the grown spheres overlap, not only their boxes, and neither element
/// has been taken out.
struct MayTouch {
  View<const Index> a, b;
  View<const ElementState> state;
  View<const double> margin;
  View<const std::uint8_t> fixed;
  double rounding;  ///< of the drift's way  [m]

  BR_HD NearSphere sphere(Index e) const { return {state[e].position, state[e].radius, margin[e]}; }
  BR_HD bool operator()(Index i) const {
    const Index p = a[i], q = b[i];
    if (is_gone(fixed[p]) || is_gone(fixed[q])) return false;
    return may_touch(sphere(p), sphere(q), rounding);
  }
};

/// Energy spent by contacts that leave the list.
struct SpentBy {
  View<const Index> contact;
  View<const double> slid, damped;
  View<const double> driven;  ///< empty between elements
  BR_HD Energies operator()(Index k) const {
    const Index i = contact[k];
    Energies spent;
    spent.friction.add(slid[i]);
    spent.contact.add(damped[i]);
    if (driven.size > 0) spent.work.add(driven[i]);
    return spent;
  }
};

/// Books what the pairs that leave the list have spent.
template <class List>
void book_dropped(World& w, const List& contacts, const Pairs& found) {
  if (contacts.size() == 0) return;
  Buffer<Index> dropped(w.exec.space);
  find_dropped(w.exec, contacts.pairs.key, found.key, dropped);
  if (dropped.empty()) return;
  const auto& h = contacts.history;
  const View<const Index> gone = std::as_const(dropped).view();
  w.ledger.book(fold_owned(w.exec, w.domain, dropped.size(), Energies{},
                           SpentBy{gone, h.slid.view(), h.damped.view(), h.work_of_walls()}, Sum{},
                           SelectedElement{gone, contacts.pairs.a.view()}));
}

/// Whether the grown sphere of an element reaches a wall.
struct WallNear {
  Wall wall;
  double reach;  ///< of the wall's own travel  [m]
  View<const ElementState> state;
  View<const double> margin;
  View<const std::uint8_t> fixed;
  BR_HD bool operator()(Index e) const {
    if (is_gone(fixed[e])) return false;
    const double height = touch(wall, state[e].position).height;
    return height <= state[e].radius + margin[e] + reach;
  }
};

/// Whether the grown sphere of an element reaches a wall made of triangles.
struct MeshNear {
  Wall wall;
  WallMesh mesh;
  double reach;  ///< of the wall's own travel  [m]
  View<const ElementState> state;
  View<const double> margin;
  View<const std::uint8_t> fixed;
  BR_HD bool operator()(Index e) const {
    if (is_gone(fixed[e])) return false;
    return is_near(mesh, into_mesh(wall, state[e].position - wall.point),
                   state[e].radius + margin[e] + reach);
  }
};

struct ListWallPairs {
  static constexpr const char* name = "dem.list_wall_pairs";
  Index wall, first;  ///< the wall, and its first pair
  int slots;          ///< pairs of each element
  View<const Index> element;
  View<const GlobalId> id;
  View<PairKey> key;
  View<Index> a, b;
  BR_HD void operator()(Index i) const {
    const Index e = element[i / slots];
    key[first + i] = wall_key(wall, id[e], i % slots);
    a[first + i] = e;
    b[first + i] = wall;
  }
};

/// Elements whose grown sphere reaches a wall, by wall, then by global id: the order of memory,
/// then by slot.
Pairs near_walls(const World& w) {
  Pairs pairs(w.exec.space);
  Index wall_number = 0;
  const auto own = [&w](const auto& near) {
    return items_where(w.exec, w.elements.size(), of_owned(w.domain, false, near));
  };
  for (const Wall& wall : w.walls) {
    // A wall that moves against the drift uses margins up, too: it may cover one largest margin
    // until it asks for a search.
    const Vec3& drift = w.travel.drift.velocity;
    const bool moves = dot(drift, drift) > 0.0 || wall.turns() ||
                       is_free(w, static_cast<std::size_t>(wall_number)) ||
                       w.prescribed.moves(w.prescribed.motions.size() - w.walls.size() +
                                          static_cast<std::size_t>(wall_number));
    const double reach = (moves ? w.given->largest_margin : 0.0) + 1e-14 * w.travel.drift.farthest;
    const WallMesh mesh = mesh_of(w, wall_number);
    const View<const ElementState> state = w.elements.state.view();
    const View<const double> margin = w.travel.margin.view();
    const View<const std::uint8_t> fixed = w.elements.fixed.view();
    const Buffer<Index> near = mesh.empty()
                                   ? own(WallNear{wall, reach, state, margin, fixed})
                                   : own(MeshNear{wall, mesh, reach, state, margin, fixed});
    const int slots = mesh.empty() ? 1 : mesh_slots;
    const Index first = pairs.size(), count = near.size() * slots;
    resize_fields(pairs, first + count);
    for_each(w.exec, count,
             ListWallPairs{wall_number, first, slots, near.view(), w.elements.id.view(),
                           pairs.key.view(), pairs.a.view(), pairs.b.view()});
    ++wall_number;
  }
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
  if (w.walls.empty()) return;
  std::vector<Index> wall_of;
  copy_to(wall_of, w.wall_contacts.pairs.b);
  w.wall_begin.assign(w.walls.size() + 1, static_cast<Index>(wall_of.size()));
  for (std::size_t k = 0; k < w.walls.size(); ++k)
    w.wall_begin[k] = static_cast<Index>(
        std::lower_bound(wall_of.begin(), wall_of.end(), static_cast<Index>(k)) - wall_of.begin());
}

struct MotionOf {
  View<const ElementState> state;
  BR_HD CommonMotion operator()(Index e) const {
    CommonMotion motion;
    motion.add(state[e].velocity);
    return motion;
  }
};
/// The drift from now on.
Drift choose_drift(const World& w) {
  const CommonMotion own = fold_owned(w.exec, w.domain, w.elements.size(), CommonMotion{},
                                      MotionOf{w.elements.state.view()}, Sum{});
  return of_all_ranks(w.domain, own).drift(w.time, 1000.0 * w.given->mean_radius);
}

/// The pairs that may touch until the next search.
void search(World& w) {
  const Index count = w.elements.size();
  Buffer<Vec3> position = unfilled<Vec3>(w.exec.space, count);
  Buffer<Vec3> velocity = unfilled<Vec3>(w.exec.space, count);
  Buffer<double> radius = unfilled<double>(w.exec.space, count);
  for_each(w.exec, count,
           UnpackState{w.travel.drift.velocity, std::as_const(w.elements.state).view(),
                       position.view(), velocity.view(), radius.view()});
  begin_travel(w.exec, margin_rule(w), position, velocity, w.travel);
  Buffer<Box> boxes(w.exec.space);
  sphere_boxes(w.exec, position, radius, w.travel.margin, boxes, w.travel.drift.farthest);
  Pairs found(w.exec.space);
  w.broad_phase.search(w.exec, boxes, w.elements.id, found, held_pairs(w));
  const View<const Index> a = std::as_const(found.a).view(), b = std::as_const(found.b).view();
  const Buffer<Index> near = items_where(
      w.exec, found.size(),
      of_either_owned(
          w.domain, a, b,
          MayTouch{a, b, w.elements.state.view(), std::as_const(w.travel.margin).view(),
                   std::as_const(w.elements.fixed).view(), 1e-14 * w.travel.drift.farthest}));
  gather_fields(w.exec, near, found);
  book_dropped(w, w.contacts, found);
  w.contacts.replace(w.exec, std::move(found));
  find_wall_contacts(w);
  derive_contacts(w);
  w.graph.clear();
  ++w.searches;
}

}  // namespace

MarginRule margin_rule(const World& w) {
  return {w.given->search.margin * w.given->mean_radius, margin_horizon * w.next_dt,
          w.given->largest_margin};
}

void ask_for_search(World& w) {
  const StageTime timed(w.exec, "travel");
  if (w.exec.space != Space::host) {  // the move has looked
    std::int32_t beyond = 0;
    peek_marked_bytes(&beyond, w.beyond.data(), w.exec.space, sizeof beyond);
    w.margin_used = beyond != 0;
    if (w.margin_used) clear_bytes(w.beyond.data(), w.exec.space, sizeof beyond);
  }
  if (!w.domain.single_rank()) w.domain.ranks->start_any_of(w.margin_used ? 1 : 0);
}

bool contacts_are_due(const World& w) {
  const StageTime timed(w.exec, "travel");
  const bool used = w.domain.single_rank() ? w.margin_used : w.domain.ranks->finish_any_of() != 0;
  if (w.given->search.every > 0)  // the paper's rule
    return w.step % w.given->search.every == 0;
  for (const Wall& wall : w.walls)
    if (wall.travelled > w.given->largest_margin) return true;
  return used;
}

void find_contacts(World& w) {
  w.domain.drift(w.travel.drift.velocity, w.time);
  w.travel.drift = choose_drift(w);
  migrate(w);
  const StageTime timed(w.exec, "contact_detection");
  const FillingThreads filling(w.exec.threads);
  collective_try(w.domain.ranks, [&w] { search(w); });
  select_active_ghosts(w);
}

void derive_contacts(World& w) {
  build_incidence(w.exec, w.contacts.pairs.a, w.contacts.pairs.b, w.elements.id,
                  w.contact_incidence);
  w.contact_actions.clear();
  w.contact_actions.resize(w.contacts.size());  // all zero: ContactForces writes what touches
  divide_by_wall(w);
  w.tiles.contacts_known = false;
}

}  // namespace breccia::dem
