#pragma once
// The bond between an element of a bar and a concrete element beside it.

#include "dem/laws/concrete_link.hpp"

namespace breccia::dem {

/// Bond stress against slip: the rising power branch of the CEB-FIP Model Code 1990 as a table over
/// sqrt(s / s_1), so that kernels need no power function; then plateau, fall and residual.
struct BondSlip {
  static constexpr int intervals = 16;
  double strength;             ///< tau_max  [Pa]
  double residual;             ///< tau_f  [Pa]
  double slip1, slip2, slip3;  ///< s_1 <= s_2 <= s_3  [m]
  double rise[intervals + 1];  ///< tau / tau_max at sqrt(s / s_1) = k / intervals  [-]

  /// tau at a slip s >= 0.  [Pa]
  template <class R>
  BR_HD R stress(const R& slip) const {
    R tau = constant<R>(strength);
    const auto rising = slip < slip1;
    if (any(rising)) {
      const R place = static_cast<double>(intervals) * sqrt(slip / slip1);
      double at[width_of<R>], from[width_of<R>], to[width_of<R>];
      __builtin_memcpy(at, &place, sizeof place);
      for (Index k = 0; k < width_of<R>; ++k) {
        const int below = at[k] < intervals ? static_cast<int>(at[k]) : intervals - 1;
        at[k] = below;
        from[k] = rise[below];
        to[k] = rise[below + 1];
      }
      const R low = pack_of<R>(from), high = pack_of<R>(to);
      tau = select(rising, strength * (low + (place - pack_of<R>(at)) * (high - low)), tau);
    }
    const auto falling = slip > slip2, fallen = slip >= slip3;
    if (any(falling || fallen)) {
      const R fall = strength - (strength - residual) * (slip - slip2) / (slip3 - slip2);
      tau = select(fallen, constant<R>(residual), select(falling, fall, tau));
    }
    return tau;
  }
};

/// State of an interface link, kept from step to step; along directions that move with the bar.
template <class R>
struct InterfaceStateOf {
  R gap;        ///< radial displacement since the start, opening positive  [m]
  R opening;    ///< largest gap so far, >= 0; link_broken or link_released afterwards  [m]
  R slip;       ///< s, along the bar  [m]
  R slip_peak;  ///< largest |s| so far  [m]
  R along;      ///< bond force on the concrete along the bar  [N]
  R around;     ///< force on the concrete around the bar  [N]
};
using InterfaceState = InterfaceStateOf<double>;

/// Response of an interface link in one step.
template <class R>
struct InterfaceResponseOf {
  Vec3Of<R> force;  ///< on b, the concrete  [N]
  R active;         ///< 1 where it resists, 0 where not  [-]
  R slid;           ///< energy spent on bond slip and friction in this step  [J]
  R broke;          ///< energy that a rupture spent in this step  [J]
};
using InterfaceResponse = InterfaceResponseOf<double>;

/// Steel-concrete interface (docs/theory.md, interface): a is the bar's element, b the concrete.
///
/// The relative motion splits along the bar (bond slip, tau(s) times the share S of the bar's
/// surface), across it radially (elastic, tension cut-off with softening) and around it (elastic).
/// After rupture: radial compression with Coulomb friction; ribs keep tau(s) (1 - u/h_r), the share
/// of their height that is still in concrete at a gap u.
struct InterfaceLink {
  BondSlip bond;
  double slip_ratio;        ///< slip stiffness over transverse stiffness, G_b / E_c  [-]
  double tensile_strength;  ///< T_B  [Pa]
  double softening;         ///< zeta  [-]
  double rupture_opening;   ///< u_2, which rules instead of zeta; 0: zeta rules  [m]
  double friction;          ///< tan phi_sc after rupture  [-]
  double rib_height;        ///< h_r, gap at which ribs come free after rupture, 0: none  [m]

  /// One link, or a pack of them (R) of which none breaks or parts in this step or has parted.
  /// @param transverse  K_tr = E_c S / D_B  [N/m]
  /// @param area        S, share of the bar's surface  [m2]
  /// @param touching    R_a + R_b  [m]
  /// @param axis        unit vector along the bar at a
  /// @param motion      of the pair; slip and normal parts together make the motion at the contact
  /// point
  /// @param approach    relative displacement of b along n in this step  [m]
  /// @returns whether that holds; if not, the links are to be taken one by one
  template <class R>
  BR_HD bool force_within(const R& transverse, const R& area, const R& touching,
                          const Vec3Of<R>& axis, const PairMotion<R>& motion, const R& approach,
                          InterfaceStateOf<R>& state, InterfaceResponseOf<R>& r) const {
    constexpr bool alone = width_of<R> == 1;
    const R zero = constant<R>(0.0);
    r = InterfaceResponseOf<R>{};
    if (any(state.opening < 0.5 * (link_broken + link_released))) return alone;
    const Vec3Of<R> radial = motion.normal - dot(motion.normal, axis) * axis;
    const R sine = norm(radial);
    const auto has_side = sine > 1e-3;  // b lies beside the bar, not on its axis
    const Vec3Of<R> out = select(has_side, (1.0 / sine) * radial, Vec3Of<R>{});
    const Vec3Of<R> round = cross(axis, out);
    const Vec3Of<R> moved = motion.slip + approach * motion.normal;

    // Radial.
    const TensionSoftening<R> tension = tension_of(transverse, area);
    state.gap += dot(moved, out);
    const R u = state.gap;
    auto intact = state.opening >= 0.0;
    R radial_force = transverse * u;  // tension positive
    state.opening = select(intact, max(state.opening, u), state.opening);
    const auto strained = intact && transverse * state.opening >= tension.strength;
    if (any(strained)) {  // at the onset or beyond
      const auto torn = strained && state.opening >= tension.rupture();
      if (any(torn)) {
        if constexpr (alone) {
          intact = false;
          r.broke = tension.toughness();
          state.opening = link_broken;
        } else {
          return false;
        }
      }
      const R softened = radial_force * (1.0 - tension.damage(state.opening));
      radial_force = select(strained && intact && u > 0.0, softened, radial_force);
    }
    const auto apart = !intact && u > 0.0;
    radial_force = select(apart, zero, radial_force);
    if (any(apart && motion.distance > 2.25 * touching)) {
      if constexpr (alone) {
        r.slid = stored(transverse, area, state);
        state = {0.0, link_released, 0.0, 0.0, 0.0, 0.0};
      }
      return alone;
    }

    // Along and around the bar.
    const R slip_stiffness = slip_ratio * transverse;
    const R step = dot(moved, axis);
    state.slip += step;
    state.slip_peak = max(state.slip_peak, abs(state.slip));
    const R grip = max(zero, -friction * radial_force);
    R bond_limit = grip, keyed = zero;
    if (rib_height > 0.0)
      keyed = max(zero, min(constant<R>(1.0), constant<R>(1.0) - u / rib_height));
    if (any(intact || keyed > 0.0)) {
      const R whole = area * bond.stress(state.slip_peak);
      // Without ribs a bit must not depend on the links beside it in a pack: max(-0, 0).
      const R ruptured = select(keyed > 0.0, max(grip, keyed * whole), grip);
      bond_limit = select(intact, whole, ruptured);
    }
    r.slid = advance(state.along, slip_stiffness, step, bond_limit);
    const R around_limit = select(intact, constant<R>(1e300), grip);
    r.slid +=
        advance(state.around, transverse, select(has_side, dot(moved, round), zero), around_limit);

    r.force = state.along * axis + state.around * round - radial_force * out;
    r.active = select(intact || u < 0.0 || keyed > 0.0, constant<R>(1.0), zero);
    return true;
  }
  BR_HD InterfaceResponse response(double transverse, double area, double touching,
                                   const Vec3& axis, const PairMotion<double>& motion,
                                   double approach, InterfaceState& state) const {
    InterfaceResponse r;
    force_within(transverse, area, touching, axis, motion, approach, state, r);
    return r;
  }

  /// Energy a link stores.  [J]
  BR_HD double stored(double transverse, double area, const InterfaceState& state) const {
    const double u = state.gap;
    const TensionSoftening<double> tension = tension_of(transverse, area);
    double energy = 0.0;
    if (u < 0.0)
      energy = 0.5 * transverse * u * u;
    else if (state.opening >= 0.0)
      energy = 0.5 * transverse * (1.0 - tension.damage(state.opening)) * u * u;
    return energy + state.along * state.along / (2.0 * slip_ratio * transverse) +
           state.around * state.around / (2.0 * transverse);
  }
  /// Energy that radial softening has spent so far.  [J]
  BR_HD double spent(double transverse, double area, const InterfaceState& state) const {
    const TensionSoftening<double> tension = tension_of(transverse, area);
    return state.opening >= 0.0 ? tension.spent(state.opening) : 0.0;
  }

 private:
  template <class R>
  BR_HD TensionSoftening<R> tension_of(const R& transverse, const R& area) const {
    TensionSoftening<R> t{transverse, tensile_strength * area, softening};
    if (rupture_opening > 0.0) {
      t.ends_given = true;
      t.last = max(constant<R>(rupture_opening), 1.02 * t.onset());
    }
    return t;
  }
  /// Elastic step of a force on b, cut at its limit; returns the energy spent.
  template <class R>
  BR_HD static R advance(R& force, const R& stiffness, const R& step, const R& limit) {
    const R before = force;
    const R trial = before - stiffness * step;
    force = max(-limit, min(limit, trial));
    const auto cut = force != trial;
    const R none = constant<R>(0.0);
    if (!any(cut)) return none;
    return select(cut, 0.5 * (before + force) * (trial - force) / stiffness, none);
  }
};

}  // namespace breccia::dem
