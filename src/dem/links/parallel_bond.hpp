#pragma once
// Parallel bonds: arrays, forces, energies.

#include "dem/laws/parallel_bond.hpp"
#include "dem/links/link_set.hpp"
#include "math/lanes.hpp"

namespace breccia::dem {

/// Bonds of cement between grains.
template <>
struct LinkArrays<ParallelBond> : LinkEnds {
  static constexpr LinkKind kind = LinkKind::parallel;
  static constexpr const char* name = "parallel";
  static constexpr bool swept = false;

  Buffer<double> length;            ///< D_eq  [m]  (constant)
  Buffer<double> stiffness;         ///< K_n  [N/m]  (constant)
  Buffer<double> strength;          ///< over its law's, by its direction  [-]  (constant)
  Buffer<ParallelBondState> state;  ///< (pairs)
  Buffer<double> slid;              ///< energy spent on sliding after rupture so far  [J]  (pairs)
  Buffer<double> broke;             ///< energy that its rupture spent  [J]  (pairs)

  template <class Visit>
  void each_field(Visit&& field) {
    LinkEnds::each_field(field);
    field("length", "m", length);
    field("stiffness", "N/m", stiffness);
    field("strength", "-", strength);
    field("state", "-", state);
    field("slid", "J", slid);
    field("broke", "J", broke);
  }

  static bool older_files_lack(std::string_view array) {
    return array == "strength" || LinkEnds::older_files_lack(array);
  }

  struct Below {
    View<const ParallelBondState> state;
    double limit;
    BR_HD bool operator()(Index i) const { return state[i].bond < limit; }
  };
  template <class>
  Below broken() const {
    return {state.view(), 0.5};
  }
  template <class>
  Below released() const {
    return {state.view(), 0.5 * bond_released};
  }
};
using ParallelBonds = LinkArrays<ParallelBond>;

/// Forces of parallel bonds, one bond or a pack of neighbours at a time.
struct ParallelBondForces {
  static constexpr const char* name = "dem.parallel_bonds";
  using Law = ParallelBond;
  Law law;
  double dt;
  ElementsView elements;
  View<const Index> a, b;
  View<const double> length, stiffness, strength;
  View<ParallelBondState> state;
  View<double> slid, broke;
  View<PairForce> actions;
  Index first_action;  ///< action of bond 0

  template <class R>
  struct Loaded {
    Indices<R> a, b;
    R length, stiffness, strength;
    ParallelBondStateOf<R> state;
    LinkPair<R> ends;
  };
  BR_HD void set(const StepTime& now) { dt = now.last_dt; }
  template <class R>
  BR_HD void load_early(Index i, Loaded<R>& loaded) const {
    loaded.a = load_indices_now<R>(a, i);
    loaded.b = load_indices_now<R>(b, i);
    loaded.length = load_now<R>(length, i);
    loaded.stiffness = load_now<R>(stiffness, i);
    loaded.strength = load_now<R>(strength, i);
    R s[8];
    gather_records(View<const ParallelBondState>(state), consecutive<R>(i), s);
    loaded.state = {s[0], s[1], {s[2], s[3], s[4]}, {s[5], s[6], s[7]}};
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
  /// @returns false, having done nothing, if the bonds of a pack are to be taken one by one
  template <class R>
  BR_HD bool update(const ParallelBond& by, Index i, const Loaded<R>& loaded) const {
    const R &radius_a = loaded.ends.radius_a, &radius_b = loaded.ends.radius_b;
    const PairMotion<R> motion = pair_motion<R>(loaded.ends.motion, radius_a - radius_b, dt);
    const auto k =
        by.constants(loaded.length, loaded.stiffness, loaded.strength, radius_a, radius_b);
    ParallelBondStateOf<R> kept = loaded.state;
    ParallelBondResponseOf<R> r;
    if constexpr (width_of<R> == 1)
      r = by.response(k, motion, kept);
    else if (!by.stays_whole(k, motion, kept, r))
      return false;
    const R s[8] = {kept.bond,    kept.strained, kept.shear.x,  kept.shear.y,
                    kept.shear.z, kept.moment.x, kept.moment.y, kept.moment.z};
    store_records(state, i, s);
    if (any(r.slid != 0.0)) store(slid, i, load<R>(slid, i) + r.slid);
    if (any(r.broke != 0.0)) store(broke, i, load<R>(broke, i) + r.broke);
    const R kn = r.active * k.stiffness, ks = by.shear_ratio * kn;
    const R none = constant<R>(0.0);
    const auto holds = kept.bond > 0.5;
    write_pair_force(actions, first_action + i, motion, r.shear - r.normal * motion.normal,
                     r.moment, kn, ks, select(holds, k.bending(), none),
                     select(holds, by.twisting(k), none));
    return true;
  }
};
template <class>
ParallelBondForces forces_of(ParallelBonds& p, const ParallelBond& law, const LinkSpace& in,
                             Buffer<PairForce>& actions) {
  return {law,
          in.dt,
          in.elements,
          p.a.view(),
          p.b.view(),
          p.length.view(),
          p.stiffness.view(),
          p.strength.view(),
          p.state.view(),
          p.slid.view(),
          p.broke.view(),
          actions.view(),
          0};
}

/// Energies of parallel bonds.
struct ParallelShares {
  View<const ElementState> state_of;
  View<const Index> a, b;
  View<const double> length, stiffness;
  View<const ParallelBondState> state;
  View<const double> slid, broke;

  BR_HD void add_to(Energies& s, const ParallelBond& law, Index i) const {
    const ElementState &one = state_of[a[i]], &other = state_of[b[i]];
    const Vec3 d = other.position - one.position;
    const double distance = norm(d);
    const auto k = law.constants(length[i], stiffness[i], 1.0, one.radius, other.radius);
    s.elastic.add(law.stored(k, (1.0 / distance) * d, distance - length[i], state[i]));
    s.fracture.add(broke[i]);
    s.friction.add(slid[i]);
  }
};
template <class>
ParallelShares shares_of(const ParallelBonds& p, const View<const ElementState>& state) {
  return {state,          p.a.view(),    p.b.view(),    p.length.view(), p.stiffness.view(),
          p.state.view(), p.slid.view(), p.broke.view()};
}

/// How far a bond has gone. All arrays on the host.
inline LinkStage stage_of(const ParallelBond&, const ParallelBonds& p, const Elements&, Index i) {
  return p.state.data()[i].bond < 0.5 ? LinkStage::broken : LinkStage::whole;
}

}  // namespace breccia::dem
