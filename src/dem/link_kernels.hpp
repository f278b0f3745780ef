#pragma once
// One kernel for each kind of link (Durand 2012, 4.2): reads, one law call, one write.

#include "core/step_clock.hpp"
#include "dem/elements.hpp"
#include "dem/links.hpp"
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

/// The end of every link of a pack and its radius.
template <class R>
BR_HD PairEnd<R> gather_end(const View<const ElementState>& state, const Indices<R>& i, R& radius) {
  R c[10];
  gather_records(state, i, c);
  radius = c[9];
  return {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}};
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
  BR_HD void at(Index i) const {
    const Indices<R> ia = load_indices<R>(a, i), ib = load_indices<R>(b, i);
    R radius_a, radius_b;
    const PairEnd<R> end_a = gather_end(elements.state, ia, radius_a);
    const PairEnd<R> end_b = gather_end(elements.state, ib, radius_b);
    answer(i, end_a, radius_a, end_b, radius_b, load<R>(length, i), load<R>(stiffness, i),
           LinkState<R>{load<R>(opening, i), load<R>(shear, i), load<R>(moment, i)});
  }
  /// What link i does with its ends, its length and stiffness, and what it kept.
  template <class R>
  BR_HD void answer(Index i, const PairEnd<R>& end_a, const R& radius_a, const PairEnd<R>& end_b,
                    const R& radius_b, const R& free_length, const R& own_stiffness,
                    LinkState<R> state) const {
    constexpr double pi = 3.14159265358979323846;
    const PairMotion<R> motion = pair_motion<R>(end_a, end_b, radius_a - radius_b, dt);
    const R least = smaller(radius_a, radius_b), touching = radius_a + radius_b;
    const LinkConstants<R> link{free_length, own_stiffness, pi * least * least, 0.5 * touching,
                                touching};
    const LinkResponse<R> r = law.answer(link, motion, state);

    if constexpr (std::is_same_v<Number, float>) {
      const BitsOf<R> chance = chance_of(motion.distance, step);
      state.shear = rounded_by(chance, 0, state.shear);
      state.moment = rounded_by(chance, 18, state.moment);
      if (law.wears()) state.opening = rounded_by<R>(chance >> 35, state.opening);
    }
    store(opening, i, state.opening);
    store(shear, i, state.shear);
    store(moment, i, state.moment);
    if (any(r.shortened != 0.0)) store(length, i, link.length - r.shortened);
    if (any(r.slid != 0.0)) store(slid, i, load<R>(slid, i) + r.slid);
    if (any(r.yielded != 0.0)) store(yielded, i, load<R>(yielded, i) + r.yielded);
    if (any(r.broke != 0.0)) store(broke, i, load<R>(broke, i) + r.broke);

    const R kn = r.active * link.stiffness, kt = law.shear_ratio * kn;
    const R kr = law.rolling_ratio * kt * link.radius * link.radius;
    book(actions, first_action + i, motion, r.shear - r.normal * motion.normal, r.moment, kn, kt,
         kr, kr);
  }
  BR_HD void set(const StepTime& now) {
    dt = now.last_dt;
    step = now.step;
  }
  BR_WHOLE BR_HD void operator()(Index i) const { at<double>(i); }
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

  BR_HD void set(const StepTime& now) { dt = now.last_dt; }
  BR_WHOLE BR_HD void operator()(Index i) const { at<double>(i); }
  /// Link i and its neighbours in a pack. @returns false, having done nothing, if they are to be
  /// taken one by one
  template <class R>
  BR_HD bool at(Index i) const {
    R radius_a, radius_b;
    const PairEnd<R> end_a = gather_end(elements.state, load_indices<R>(a, i), radius_a);
    const PairEnd<R> end_b = gather_end(elements.state, load_indices<R>(b, i), radius_b);
    const PairMotion<R> motion = pair_motion<R>(end_a, end_b, constant<R>(0.0), dt);
    const R own_length = load<R>(length, i), radius = smaller(radius_a, radius_b);
    const SteelLink::StiffnessOf<R> k = law.stiffness(own_length, radius);
    SteelStateOf<R> kept = load_state<R>(View<const SteelState>(state), i);
    SteelResponseOf<R> r;
    if constexpr (width_of<R> == 1)
      r = law.answer(own_length, radius, motion, kept);
    else if (!law.stays_elastic(k, own_length, radius, motion, kept, r))
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

  BR_HD void set(const StepTime& now) { dt = now.last_dt; }
  BR_WHOLE BR_HD void operator()(Index i) const { with(law, i); }
  /// By a law that stays where it is: it holds a table.
  BR_HD void with(const InterfaceLink& bond, Index i) const { at<double>(bond, i); }
  /// Link i and its neighbours in a pack. @returns false, having done nothing, if they are to be
  /// taken one by one
  template <class R>
  BR_HD bool at(const InterfaceLink& bond, Index i) const {
    R radius_a, radius_b;
    const PairEnd<R> bar = gather_end(elements.state, load_indices<R>(a, i), radius_a);
    const PairEnd<R> concrete = gather_end(elements.state, load_indices<R>(b, i), radius_b);
    const Vec3Of<R> chord =
        place_of(load_indices<R>(after, i)) - place_of(load_indices<R>(before, i));
    const Vec3Of<R> axis = (1.0 / norm(chord)) * chord;
    // The contact point divides the distance like the radii: a bar is thin beside its concrete.
    const R touching = radius_a + radius_b, share = (radius_a - radius_b) / touching;
    const R distance = norm(concrete.position - bar.position);
    const PairMotion<R> motion = pair_motion<R>(bar, concrete, share * distance, dt);
    InterfaceStateOf<R> kept = load_state<R>(View<const InterfaceState>(state), i);
    const R transverse = load<R>(stiffness, i);
    InterfaceResponseOf<R> r;
    if (!bond.respond(transverse, load<R>(area, i), touching, axis, motion, motion.extension, kept,
                      r))
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
