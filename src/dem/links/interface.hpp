#pragma once
// Bonds between bars and concrete: arrays, forces, energies.

#include "dem/laws/interface_link.hpp"
#include "dem/links/link_set.hpp"
#include "math/lanes.hpp"

namespace breccia::dem {

/// Bonds between bars and concrete: a is the bar's element, b the concrete's.
template <>
struct LinkArrays<InterfaceLink> : LinkEnds {
  static constexpr LinkKind kind = LinkKind::interface;
  static constexpr const char* name = "interface";
  static constexpr bool swept = false;

  Buffer<Index> before,
      after;  ///< neighbours of a along its bar (a itself at an end): they give the axis  [-]
              ///< (ends)
  Buffer<double> stiffness;      ///< K_tr  [N/m]  (constant)
  Buffer<double> area;           ///< S, share of the bar's surface  [m2]  (constant)
  Buffer<InterfaceState> state;  ///< (pairs)
  Buffer<double> slid;           ///< energy spent on bond slip and friction so far  [J]  (pairs)
  Buffer<double> broke;          ///< energy that its rupture spent  [J]  (pairs)

  template <class Visit>
  void each_field(Visit&& field) {
    LinkEnds::each_field(field);
    field("before", "-", before);
    field("after", "-", after);
    field("stiffness", "N/m", stiffness);
    field("area", "m2", area);
    field("state", "-", state);
    field("slid", "J", slid);
    field("broke", "J", broke);
  }
  template <class Visit>
  void each_end(Visit&& visit) {
    LinkEnds::each_end(visit);
    visit("before", before);
    visit("after", after);
  }
  template <class Visit>
  void each_end(Visit&& visit) const {
    LinkEnds::each_end(visit);
    visit("before", before);
    visit("after", after);
  }

  struct Below {
    View<const InterfaceState> state;
    double limit;
    BR_HD bool operator()(Index i) const { return state[i].opening < limit; }
  };
  template <class>
  Below broken() const {
    return {state.view(), 0.0};
  }
  template <class>
  Below released() const {
    return {state.view(), 0.5 * (link_broken + link_released)};
  }
};
using InterfaceLinks = LinkArrays<InterfaceLink>;

/// Numbers of links first, first + 1, ... as their state.
template <class R>
BR_HD InterfaceStateOf<R> load_state(const View<const InterfaceState>& states, Index first) {
  R s[6];
  gather_records(states, consecutive<R>(first), s);
  return {s[0], s[1], s[2], s[3], s[4], s[5]};
}
template <class R>
BR_HD void store_state(const View<InterfaceState>& states, Index first,
                       const InterfaceStateOf<R>& state) {
  const R s[6] = {state.gap, state.opening, state.slip, state.slip_peak, state.along, state.around};
  store_records(states, first, s);
}

/// Bonds between bars and concrete.
/// @tparam Actions  where actions go
template <class Actions>
struct InterfaceLinkForcesTo {
  static constexpr const char* name = "dem.interface_links";
  using Law = InterfaceLink;
  Law law;
  double dt;
  ElementsView elements;
  View<const Index> a, b, before, after;
  View<const double> stiffness, area;
  View<InterfaceState> state;
  View<double> slid, broke;
  Actions actions;
  Index first_action;  ///< action of link 0

  template <class R>
  struct Loaded {
    Indices<R> a, b, before, after;
    R stiffness, area;
    InterfaceStateOf<R> state;
    LinkEnd<R> bar, concrete;
    Vec3Of<R> chord;  ///< between the neighbours of the bar's element  [m]
  };
  BR_HD void set(const StepTime& now) { dt = now.last_dt; }
  template <class R>
  BR_HD void load_early(Index i, Loaded<R>& loaded) const {
    loaded.a = load_indices_now<R>(a, i);
    loaded.b = load_indices_now<R>(b, i);
    loaded.before = load_indices_now<R>(before, i);
    loaded.after = load_indices_now<R>(after, i);
    loaded.stiffness = load_now<R>(stiffness, i);
    loaded.area = load_now<R>(area, i);
    loaded.state = load_state<R>(View<const InterfaceState>(state), i);
  }
  template <class R>
  BR_HD void load_late(Index, Loaded<R>& loaded) const {
    loaded.bar = load_end<R>(elements.state, loaded.a);
    loaded.concrete = load_end<R>(elements.state, loaded.b);
    loaded.chord = place_of(loaded.after) - place_of(loaded.before);
  }
  BR_WHOLE BR_HD void operator()(Index i) const { run_at<double>(*this, i); }
  template <class R>
  BR_HD bool update(Index i, const Loaded<R>& loaded) const {
    return update(law, i, loaded);
  }
  /// @param by  a law that stays where it is: it holds a table
  /// @returns false, having done nothing, if the links of a pack are to be taken one by one
  template <class R>
  BR_HD bool update(const InterfaceLink& by, Index i, const Loaded<R>& loaded) const {
    const R &radius_a = loaded.bar.radius, &radius_b = loaded.concrete.radius;
    const PairEnd<R>&bar = loaded.bar.motion, &concrete = loaded.concrete.motion;
    const Vec3Of<R> axis = (1.0 / norm(loaded.chord)) * loaded.chord;
    // The contact point divides the distance like the radii: a bar is thin beside its concrete.
    const R touching = radius_a + radius_b, share = (radius_a - radius_b) / touching;
    const R distance = norm(concrete.position - bar.position);
    const PairMotion<R> motion = pair_motion<R>(bar, concrete, share * distance, dt);
    InterfaceStateOf<R> kept = loaded.state;
    const R transverse = loaded.stiffness;
    InterfaceResponseOf<R> r;
    if (!by.force_within(transverse, loaded.area, touching, axis, motion, motion.extension, kept,
                         r))
      return false;
    store_state(state, i, kept);
    if (any(r.slid != 0.0)) book(actions, slid, i, r.slid);
    if (any(r.broke != 0.0)) book(actions, broke, i, r.broke);
    const R k = r.active * transverse, none = constant<R>(0.0);
    write_pair_force(actions, first_action + i, motion, r.force, Vec3Of<R>{}, k, k, none, none);
    return true;
  }

 private:
  template <class R>
  BR_HD Vec3Of<R> place_of(const Indices<R>& i) const {
    R numbers[4];
    gather_records(elements.state, i, numbers);
    return {numbers[0], numbers[1], numbers[2]};
  }
};
using InterfaceLinkForces = InterfaceLinkForcesTo<View<PairForce>>;

template <class>
InterfaceLinkForces forces_of(InterfaceLinks& b, const InterfaceLink& law, const LinkSpace& in,
                              Buffer<PairForce>& actions) {
  return {law,
          in.dt,
          in.elements,
          b.a.view(),
          b.b.view(),
          b.before.view(),
          b.after.view(),
          b.stiffness.view(),
          b.area.view(),
          b.state.view(),
          b.slid.view(),
          b.broke.view(),
          actions.view(),
          0};
}

/// Energies of bonds.
struct InterfaceShares {
  View<const Index> a;
  View<const double> stiffness, area;
  View<const InterfaceState> state;
  View<const double> slid, broke;

  BR_HD void add_to(Energies& s, const InterfaceLink& law, Index i) const {
    s.elastic.add(law.stored(stiffness[i], area[i], state[i]));
    s.fracture.add(broke[i]);
    s.fracture.add(law.spent(stiffness[i], area[i], state[i]));
    s.friction.add(slid[i]);
  }
};

template <class>
InterfaceShares shares_of(const InterfaceLinks& b, const View<const ElementState>&) {
  return {b.a.view(),     b.stiffness.view(), b.area.view(),
          b.state.view(), b.slid.view(),      b.broke.view()};
}

/// How far a bond has gone. All arrays on the host.
inline LinkStage stage_of(const InterfaceLink&, const InterfaceLinks& b, const Elements&, Index i) {
  return b.state.data()[i].opening < 0.0 ? LinkStage::broken : LinkStage::whole;
}

}  // namespace breccia::dem
