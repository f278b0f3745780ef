#pragma once
// The kernels of a step with the arrays of a world: the same for loops on the host and for launches
// ahead on a device.

#include "dem/stepping/wide_kernels.hpp"
#include "dem/world.hpp"

namespace breccia::dem {

/// Calls visit(begin, end) for what this rank owns of the elements [begin, end) in some runs.
template <class Visit>
inline void each_owned(const Domain& domain, const std::vector<ElementRun>& runs, Index begin,
                       Index end, const Visit& visit) {
  if (domain.single_rank()) return visit(begin, end);
  const OwnedView owned = domain.owned_view();
  Domain::each_run_of(runs, begin, end, [&](Index from, Index to) {
    while (from < to) {
      Index last = from;
      while (last < to && owned(last)) ++last;
      if (last > from) visit(from, last);
      from = last + 1;
    }
  });
}

/// Whether the sums of a step on a device of several note their least critical number in `w.clock`,
/// where the move has made room for it.
inline bool sums_note_least(const World& w) {
  return !w.domain.single_rank() && w.walls.empty() && !w.clock.empty() && w.elements.size() > 0;
}

/// Actions of links of a device's launches.
template <class Number>
auto split_actions(World& w) {
  using Stored = StoredAs<Number>;
  return SplitActions<Stored>(w.link_actions.as<Stored>().view());
}

/// Whether the step that is being taken ends with an evaluation of the critical step.
inline bool evaluates_now(const World& w) {
  return w.step % w.given->time.evaluate_every == 0;
}
inline LinkSpace link_space(const World& w) {
  return {elements_view(w), w.last_dt, w.step, evaluates_now(w)};
}

/// Forces of links by a law, with the arrays of all links of its kind.
/// @param first_action  action of link 0 among those of `bar_actions`; 0 for swept links
template <class Number, class Law>
auto link_kernel(World& w, LinkSet<Law>& set, const Law& law, Index first_action) {
  const LinkSpace space = link_space(w);
  if constexpr (LinkSet<Law>::swept) {
    return forces_of<Number>(set, law, space, w.link_actions.as<Number>().view());
  } else {
    auto kernel = forces_of<Number>(set, law, space, w.bar_actions);
    if constexpr (requires { kernel.first_action; }) kernel.first_action = first_action;
    return kernel;
  }
}

/// Forces of swept links for a device's launches.
template <class Number>
auto split_link_kernel(World& w) {
  return forces_of<Number>(w.concrete, ConcreteLink{}, link_space(w), split_actions<Number>(w));
}

/// Forces of the edges of facets, with the arrays of all of them.
inline LdpmEdgeForces edge_kernel(World& w) {
  const Index first_action = w.steel.size() + w.interface.size() + w.parallel.size();
  return edge_forces_of(w.ldpm, elements_view(w), w.bar_actions, first_action);
}

/// Calls visit(set, first_action) for each kind of links whose forces the host does not sum by
/// tiles.
template <class Visit>
void each_bar_set(World& w, const Visit& visit) {
  Index first = 0;
  w.each_set([&](auto& set) {
    if constexpr (!std::remove_reference_t<decltype(set)>::swept) {
      visit(set, first);
      first += set.size();
    }
  });
}

inline ContactForces contact_kernel(World& w) {
  Contacts& c = w.contacts;
  return {w.given->contact,
          w.last_dt,
          elements_view(w),
          w.elements.material.view(),
          w.given->contact_pairs.view(),
          w.given->materials,
          c.pairs.a.view(),
          c.pairs.b.view(),
          c.history.state.view(),
          c.history.slid.view(),
          c.history.damped.view(),
          w.contact_actions.view()};
}

inline GatherForces gather_kernel(World& w) {
  Elements& e = w.elements;
  return {w.link_sums.view(),   w.bar_incidence.view(),   w.contact_incidence.view(),
          w.bar_actions.view(), w.contact_actions.view(), e.mass.view(),
          e.inertia.view(),     e.fixed.view(),           e.force.view(),
          e.torque.view(),      w.critical.view(),        evaluates_now(w)};
}

template <class Number>
GatherWide<Number> gather_wide_kernel(World& w) {
  return {gather_kernel(w), w.rows_a.view(), w.rows_b.view(), split_actions<Number>(w),
          w.domain.owned_view()};
}

inline WallForces wall_kernel(World& w, Index wall) {
  WallContacts& c = w.wall_contacts;
  ContactLaw law = w.given->contact;
  const double own = w.given->wall_friction[static_cast<std::size_t>(wall)];
  if (own >= 0.0) law.friction = own;
  return {
      law,
      w.last_dt,
      walls_view(w),
      wall,
      elements_view(w),
      w.elements.material.view(),
      w.given->wall_pairs.view(),
      c.pairs.a.view(),
      w.wall_begin[static_cast<std::size_t>(wall)],
      w.free_walls.empty() ? no_limit : w.given->free_walls[static_cast<std::size_t>(wall)].mass,
      c.history.state.view(),
      c.history.slid.view(),
      c.history.damped.view(),
      c.history.driven.view(),
      c.history.on_wall.view(),
      w.elements.force.view(),
      w.elements.torque.view(),
      w.critical.view()};
}

/// Calls visit(items, kernel) for the forces of each wall.
template <class Visit>
void each_wall_kernel(World& w, const Visit& visit) {
  for (std::size_t k = 0; k < w.walls.size(); ++k) {
    const auto wall = static_cast<Index>(k);
    const Index count = w.wall_begin[k + 1] - w.wall_begin[k];
    if (const WallMesh mesh = mesh_of(w, wall); mesh.empty())
      visit(count, wall_kernel(w, wall));
    else
      visit(count / mesh_slots,
            MeshForces{wall_kernel(w, wall), mesh, w.wall_contacts.history.place.view()});
  }
}

inline MoveElements move_kernel(World& w) {
  Elements& e = w.elements;
  UsedMargin used{w.travel.reference.view(), w.travel.margin.view(), w.travel.drift, {}, false};
  used.set_time(w.time + w.next_dt);
  return {kick(w), e.state.view(), e.orientation.view(), e.damping_work.view(), e.load_work.view(),
          used};
}

}  // namespace breccia::dem
