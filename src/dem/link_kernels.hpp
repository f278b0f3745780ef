#pragma once
// One kernel for each kind of link (Durand 2012, 4.2): reads, one law call, one write.

#include "core/step_clock.hpp"
#include "dem/elements.hpp"
#include "dem/links.hpp"

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
struct ConcreteLinkForces {
  static constexpr const char* name = "dem.concrete_links";
  ConcreteLink law;
  double dt;  ///< the step that moved the elements to where they are  [s]
  ElementsView elements;
  View<const Index> a, b;
  View<const double> length, stiffness;
  View<double> opening;
  PlanesView<double> shear, moment;
  View<double> slid, yielded, broke;
  View<Action> actions;
  Index first_action;  ///< action of link 0

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

    store(opening, i, state.opening);
    store(shear, i, state.shear);
    store(moment, i, state.moment);
    if (any(r.slid != 0.0)) store(slid, i, load<R>(slid, i) + r.slid);
    if (any(r.yielded != 0.0)) store(yielded, i, load<R>(yielded, i) + r.yielded);
    if (any(r.broke != 0.0)) store(broke, i, load<R>(broke, i) + r.broke);

    const R kn = r.active * link.stiffness, kt = law.shear_ratio * kn;
    const R kr = law.rolling_ratio * kt * link.radius * link.radius;
    book(actions, first_action + i, motion, r.shear - r.normal * motion.normal, r.moment, kn, kt,
         kr, kr);
  }
  BR_HD void set(const Moment& now) { dt = now.last_dt; }
  BR_WHOLE BR_HD void operator()(Index i) const { at<double>(i); }
};

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

  BR_HD void set(const Moment& now) { dt = now.last_dt; }
  BR_WHOLE BR_HD void operator()(Index i) const {
    const PairMotion<double> motion =
        pair_motion<double>(elements.end(a[i]), elements.end(b[i]), 0.0, dt);
    const double radius = smaller(elements.radius(a[i]), elements.radius(b[i]));
    SteelState kept = state[i];
    const SteelResponse r = law.answer(length[i], radius, motion, kept);
    state[i] = kept;
    yielded[i] += r.yielded;
    broke[i] += r.broke;
    const SteelLink::Stiffness k = law.stiffness(length[i], radius);
    const bool whole = kept.hardening >= 0.0;
    book(actions, first_action + i, motion, r.shear - r.normal * motion.normal, r.moment,
         r.active * k.axial, whole ? k.shear : 0.0, whole ? k.bending : 0.0, whole ? k.twist : 0.0);
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

  BR_HD void set(const Moment& now) { dt = now.last_dt; }
  BR_WHOLE BR_HD void operator()(Index i) const { with(law, i); }
  /// By a law that stays where it is: it holds a table.
  BR_HD void with(const InterfaceLink& bond, Index i) const {
    const PairEnd<double> bar = elements.end(a[i]), concrete = elements.end(b[i]);
    const Vec3 chord = elements.state[after[i]].position - elements.state[before[i]].position;
    const Vec3 axis = (1.0 / norm(chord)) * chord;
    // The contact point divides the distance like the radii: a bar is thin beside its concrete.
    const double touching = elements.radius(a[i]) + elements.radius(b[i]);
    const double share = (elements.radius(a[i]) - elements.radius(b[i])) / touching;
    const double distance = norm(concrete.position - bar.position);
    const PairMotion<double> motion = pair_motion<double>(bar, concrete, share * distance, dt);
    const double approach = dt * dot(concrete.velocity - bar.velocity, motion.normal);
    InterfaceState kept = state[i];
    const InterfaceResponse r =
        bond.answer(stiffness[i], area[i], touching, axis, motion, approach, kept);
    state[i] = kept;
    slid[i] += r.slid;
    broke[i] += r.broke;
    const double k = r.active * stiffness[i];
    book(actions, first_action + i, motion, r.force, Vec3{}, k, k, 0.0, 0.0);
  }
};

}  // namespace breccia::dem
