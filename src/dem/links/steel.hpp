#pragma once
// Pieces of reinforcing bar: arrays, forces, energies.

#include "dem/laws/steel_link.hpp"
#include "dem/links/link_set.hpp"
#include "math/lanes.hpp"

namespace breccia::dem {

/// Pieces of bar.
template <>
struct LinkArrays<SteelLink> : LinkEnds {
  static constexpr LinkKind kind = LinkKind::steel;
  static constexpr const char* name = "steel";
  static constexpr bool swept = false;

  Buffer<double> length;     ///< L_s  [m]  (constant)
  Buffer<SteelState> state;  ///< (pairs)
  Buffer<double> yielded;    ///< energy spent on yielding so far  [J]  (pairs)
  Buffer<double> broke;      ///< energy that its rupture spent  [J]  (pairs)

  template <class Visit>
  void each_field(Visit&& field) {
    LinkEnds::each_field(field);
    field("length", "m", length);
    field("state", "-", state);
    field("yielded", "J", yielded);
    field("broke", "J", broke);
  }

  struct Broken {
    View<const SteelState> state;
    BR_HD bool operator()(Index i) const { return state[i].hardening < 0.0; }
  };
  template <class>
  Broken broken() const {
    return {state.view()};
  }
  /// A ruptured bar still bears compression.
  struct Never {
    BR_HD bool operator()(Index) const { return false; }
  };
  template <class>
  Never released() const {
    return {};
  }
};
using SteelLinks = LinkArrays<SteelLink>;

/// Numbers of links first, first + 1, ... as their state.
template <class R>
BR_HD SteelStateOf<R> load_state(const View<const SteelState>& states, Index first) {
  R s[8];
  gather_records(states, consecutive<R>(first), s);
  return {s[0], s[1], {s[2], s[3], s[4]}, {s[5], s[6], s[7]}};
}
template <class R>
BR_HD void store_state(const View<SteelState>& states, Index first, const SteelStateOf<R>& state) {
  const Vec3Of<R>&f = state.shear, &m = state.moment;
  const R s[8] = {state.plastic_strain, state.hardening, f.x, f.y, f.z, m.x, m.y, m.z};
  store_records(states, first, s);
}
/// Pieces of bar.
/// @tparam Actions  where actions go
template <class Actions>
struct SteelLinkForcesTo {
  static constexpr const char* name = "dem.steel_links";
  using Law = SteelLink;
  Law law;
  double dt;
  ElementsView elements;
  View<const Index> a, b;
  View<const double> length;
  View<SteelState> state;
  View<double> yielded, broke;
  Actions actions;
  Index first_action;  ///< action of link 0

  template <class R>
  struct Loaded {
    Indices<R> a, b;
    R length;
    SteelStateOf<R> state;
    LinkPair<R> ends;
  };
  BR_HD void set(const StepTime& now) { dt = now.last_dt; }
  template <class R>
  BR_HD void load_early(Index i, Loaded<R>& loaded) const {
    loaded.a = load_indices_now<R>(a, i);
    loaded.b = load_indices_now<R>(b, i);
    loaded.length = load_now<R>(length, i);
    loaded.state = load_state<R>(View<const SteelState>(state), i);
  }
  template <class R>
  BR_HD void load_late(Index, Loaded<R>& loaded) const {
    loaded.ends = load_pair<R>(elements.state, loaded.a, loaded.b);
  }
  BR_WHOLE BR_HD void operator()(Index i) const { run_at<double>(*this, i); }
  template <class R>
  BR_HD bool update(Index i, const Loaded<R>& loaded) const {
    return update(law, i, loaded);
  }
  /// @returns false, having done nothing, if the links of a pack are to be taken one by one
  template <class R>
  BR_HD bool update(const SteelLink& by, Index i, const Loaded<R>& loaded) const {
    const PairMotion<R> motion = pair_motion<R>(loaded.ends.motion, constant<R>(0.0), dt);
    const R own_length = loaded.length;
    const R radius = min(loaded.ends.radius_a, loaded.ends.radius_b);
    const SteelLink::StiffnessOf<R> k = by.stiffness(own_length, radius);
    SteelStateOf<R> kept = loaded.state;
    SteelResponseOf<R> r;
    if constexpr (width_of<R> == 1)
      r = by.response(own_length, radius, motion, kept);
    else if (!by.elastic_response(k, own_length, radius, motion, kept, r))
      return false;
    store_state(state, i, kept);
    if (any(r.yielded != 0.0)) book(actions, yielded, i, r.yielded);
    if (any(r.broke != 0.0)) book(actions, broke, i, r.broke);
    const auto whole = kept.hardening >= 0.0;
    const R none = constant<R>(0.0);
    write_pair_force(actions, first_action + i, motion, r.shear - r.normal * motion.normal,
                     r.moment, r.active * k.axial, select(whole, k.shear, none),
                     select(whole, k.bending, none), select(whole, k.twist, none));
    return true;
  }
};
using SteelLinkForces = SteelLinkForcesTo<View<PairForce>>;

template <class>
SteelLinkForces forces_of(SteelLinks& s, const SteelLink& law, const LinkSpace& in,
                          Buffer<PairForce>& actions) {
  return {law,
          in.dt,
          in.elements,
          s.a.view(),
          s.b.view(),
          s.length.view(),
          s.state.view(),
          s.yielded.view(),
          s.broke.view(),
          actions.view(),
          0};
}

/// Energies of bars.
struct SteelShares {
  View<const ElementState> state_of;
  View<const Index> a, b;
  View<const double> length;
  View<const SteelState> state;
  View<const double> yielded, broke;

  BR_HD void add_to(Energies& s, const SteelLink& law, Index i) const {
    const Vec3 d = state_of[b[i]].position - state_of[a[i]].position;
    const double distance = norm(d), r = min(state_of[a[i]].radius, state_of[b[i]].radius);
    s.elastic.add(law.stored(length[i], r, distance - length[i], state[i]));
    if (state[i].hardening >= 0.0)
      s.elastic.add(law.stored_moment(length[i], r, (1.0 / distance) * d, state[i]));
    s.fracture.add(broke[i]);
    s.plastic.add(yielded[i]);
  }
};

template <class>
SteelShares shares_of(const SteelLinks& s, const View<const ElementState>& state) {
  return {state,          s.a.view(),       s.b.view(),    s.length.view(),
          s.state.view(), s.yielded.view(), s.broke.view()};
}

/// How far a piece of bar has gone. All arrays on the host.
inline LinkStage stage_of(const SteelLink&, const SteelLinks& s, const Elements&, Index i) {
  const double hardening = s.state.data()[i].hardening;
  return hardening < 0.0   ? LinkStage::broken
         : hardening > 0.0 ? LinkStage::softened
                           : LinkStage::whole;
}

}  // namespace breccia::dem
