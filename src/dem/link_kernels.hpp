#pragma once
// One kernel for each kind of link (Durand 2012, 4.2): reads, one law call, one write.

#include "core/kernel.hpp"
#include "dem/elements.hpp"
#include "dem/links.hpp"
#include "math/constants.hpp"
#include "math/rounding.hpp"

namespace breccia::dem {

/// What pair kernels read of the elements.
struct ElementsView {
  View<const ElementState> state;
  View<const double> mass, inertia;

  BR_HD PairEnd<double> end(Index i) const {
    const ElementState& s = state[i];
    return {s.position, s.velocity, s.spin};
  }
  BR_HD double radius(Index i) const { return state[i].radius; }
};

/// One end of a link, or of each in a pack.
template <class R>
struct LinkEnd {
  PairEnd<R> motion;
  R radius;
};
template <class R>
BR_HD inline LinkEnd<R> load_end(const View<const ElementState>& state, const Indices<R>& i) {
  if constexpr (width_of<R> == 1) {
    const ElementState s = read_record_now(&state[i.at]);
    return {{s.position, s.velocity, s.spin}, s.radius};
  } else {
    R c[10];
    gather_records(state, i, c);
    return {{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}}, c[9]};
  }
}

/// Cohesive links of one material, one link (R = double) or a pack of neighbours at a time.
/// @tparam Number  what the links' history and actions are stored in
template <class Number>
struct ConcreteLinkForces {
  static constexpr const char* name = "dem.concrete_links";
  ConcreteLink law;
  double dt;  ///< the step that moved the elements to where they are  [s]
  ElementsView elements;
  View<const Index> a, b;
  View<double> length;
  View<const double> stiffness;
  View<Number> opening;
  PlanesView<Number> shear, moment;
  View<double> slid, yielded, broke;
  View<ActionOf<Number>> actions;
  Index first_action;  ///< action of link 0
  std::int64_t step;   ///< steps taken before

  template <class R>
  struct Loaded {
    Indices<R> a, b;
    R length, stiffness;
    LinkState<R> state;
    LinkEnd<R> end_a, end_b;
  };
  template <class R>
  BR_HD void load_early(Index i, Loaded<R>& loaded) const {
    loaded.a = load_indices_now<R>(a, i);
    loaded.b = load_indices_now<R>(b, i);
    loaded.length = load_now<R>(length, i);
    loaded.stiffness = load_now<R>(stiffness, i);
    loaded.state = {load_now<R>(opening, i), load_now<R>(shear, i), load_now<R>(moment, i)};
  }
  template <class R>
  BR_HD void load_late(Index, Loaded<R>& loaded) const {
    loaded.end_a = load_end<R>(elements.state, loaded.a);
    loaded.end_b = load_end<R>(elements.state, loaded.b);
  }
  template <class R>
  BR_HD void update(Index i, const Loaded<R>& loaded) const {
    update(law, i, loaded);
  }
  template <class R>
  BR_HD void update(const ConcreteLink& by, Index i, const Loaded<R>& loaded) const {
    const R &radius_a = loaded.end_a.radius, &radius_b = loaded.end_b.radius;
    const PairMotion<R> motion =
        pair_motion<R>(loaded.end_a.motion, loaded.end_b.motion, radius_a - radius_b, dt);
    const R least = smaller(radius_a, radius_b), touching = radius_a + radius_b;
    const LinkConstants<R> link{loaded.length, loaded.stiffness, pi * least * least, 0.5 * touching,
                                touching};
    LinkState<R> state = loaded.state;
    const LinkResponse<R> r = by.answer(link, motion, state);

    if constexpr (std::is_same_v<Number, float>) {
      const BitsOf<R> chance = chance_of(motion.distance, step);
      state.shear = rounded_by(chance, 0, state.shear);
      state.moment = rounded_by(chance, 18, state.moment);
      if (by.wears()) state.opening = rounded_by<R>(chance >> 35, state.opening);
    }
    store(opening, i, state.opening);
    store(shear, i, state.shear);
    store(moment, i, state.moment);
    if (any(r.shortened != 0.0)) store(length, i, link.length - r.shortened);
    if (any(r.slid != 0.0)) store(slid, i, load<R>(slid, i) + r.slid);
    if (any(r.yielded != 0.0)) store(yielded, i, load<R>(yielded, i) + r.yielded);
    if (any(r.broke != 0.0)) store(broke, i, load<R>(broke, i) + r.broke);

    const R kn = r.active * link.stiffness, kt = by.shear_ratio * kn;
    const R kr = by.rolling_ratio * kt * link.radius * link.radius;
    book(actions, first_action + i, motion, r.shear - r.normal * motion.normal, r.moment, kn, kt,
         kr, kr);
  }
  BR_HD void set(const StepTime& now) {
    dt = now.last_dt;
    step = now.step;
  }
  BR_WHOLE BR_HD void operator()(Index i) const { run_at<double>(*this, i); }
};

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

/// Pieces of bar.
struct SteelLinkForces {
  static constexpr const char* name = "dem.steel_links";
  SteelLink law;
  double dt;
  ElementsView elements;
  View<const Index> a, b;
  View<const double> length;
  View<SteelState> state;
  View<double> yielded, broke;
  View<Action> actions;
  Index first_action;  ///< action of link 0

  template <class R>
  struct Loaded {
    Indices<R> a, b;
    R length;
    SteelStateOf<R> state;
    LinkEnd<R> end_a, end_b;
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
    loaded.end_a = load_end<R>(elements.state, loaded.a);
    loaded.end_b = load_end<R>(elements.state, loaded.b);
  }
  BR_WHOLE BR_HD void operator()(Index i) const { run_at<double>(*this, i); }
  template <class R>
  BR_HD bool update(Index i, const Loaded<R>& loaded) const {
    return update(law, i, loaded);
  }
  /// @returns false, having done nothing, if the links of a pack are to be taken one by one
  template <class R>
  BR_HD bool update(const SteelLink& by, Index i, const Loaded<R>& loaded) const {
    const PairMotion<R> motion =
        pair_motion<R>(loaded.end_a.motion, loaded.end_b.motion, constant<R>(0.0), dt);
    const R own_length = loaded.length;
    const R radius = smaller(loaded.end_a.radius, loaded.end_b.radius);
    const SteelLink::StiffnessOf<R> k = by.stiffness(own_length, radius);
    SteelStateOf<R> kept = loaded.state;
    SteelResponseOf<R> r;
    if constexpr (width_of<R> == 1)
      r = by.answer(own_length, radius, motion, kept);
    else if (!by.stays_elastic(k, own_length, radius, motion, kept, r))
      return false;
    store_state(state, i, kept);
    if (any(r.yielded != 0.0)) store(yielded, i, load<R>(yielded, i) + r.yielded);
    if (any(r.broke != 0.0)) store(broke, i, load<R>(broke, i) + r.broke);
    const auto whole = kept.hardening >= 0.0;
    const R none = constant<R>(0.0);
    book(actions, first_action + i, motion, r.shear - r.normal * motion.normal, r.moment,
         r.active * k.axial, choose(whole, k.shear, none), choose(whole, k.bending, none),
         choose(whole, k.twist, none));
    return true;
  }
};

/// Bonds between bars and concrete.
struct InterfaceLinkForces {
  static constexpr const char* name = "dem.interface_links";
  InterfaceLink law;
  double dt;
  ElementsView elements;
  View<const Index> a, b, before, after;
  View<const double> stiffness, area;
  View<InterfaceState> state;
  View<double> slid, broke;
  View<Action> actions;
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
    if (!by.respond(transverse, loaded.area, touching, axis, motion, motion.extension, kept, r))
      return false;
    store_state(state, i, kept);
    if (any(r.slid != 0.0)) store(slid, i, load<R>(slid, i) + r.slid);
    if (any(r.broke != 0.0)) store(broke, i, load<R>(broke, i) + r.broke);
    const R k = r.active * transverse, none = constant<R>(0.0);
    book(actions, first_action + i, motion, r.force, Vec3Of<R>{}, k, k, none, none);
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

}  // namespace breccia::dem
