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
  BR_HD double stress(double slip) const {
    if (slip >= slip3) return residual;
    if (slip > slip2) return strength - (strength - residual) * (slip - slip2) / (slip3 - slip2);
    if (slip >= slip1) return strength;
    const double place = intervals * root(slip / slip1);
    const int k = static_cast<int>(place) < intervals ? static_cast<int>(place) : intervals - 1;
    return strength * (rise[k] + (place - k) * (rise[k + 1] - rise[k]));
  }
};

/// What an interface link keeps from step to step; all along directions that move with the bar.
struct InterfaceState {
  double gap;        ///< radial displacement since the start, opening positive  [m]
  double opening;    ///< largest gap so far, >= 0; link_broken or link_released afterwards  [m]
  double slip;       ///< s, along the bar  [m]
  double slip_peak;  ///< largest |s| so far  [m]
  double along;      ///< bond force on the concrete along the bar  [N]
  double around;     ///< force on the concrete around the bar  [N]
};

/// What an interface link answers in one step.
struct InterfaceResponse {
  Vec3 force;     ///< on b, the concrete  [N]
  double active;  ///< 1 where it resists, 0 where not  [-]
  double slid;    ///< energy spent on bond slip and friction in this step  [J]
  double broke;   ///< energy that a rupture spent in this step  [J]
};

/// Steel-concrete interface (docs/theory.md, interface): a is the bar's element, b the concrete.
///
/// The relative motion splits along the bar (bond slip, tau(s) times the share S of the bar's
/// surface), across it radially (elastic, tension cut-off with softening) and around it (elastic).
/// After rupture: radial compression with Coulomb friction.
struct InterfaceLink {
  BondSlip bond;
  double slip_ratio;        ///< slip stiffness over transverse stiffness, G_b / E_c  [-]
  double tensile_strength;  ///< T_B  [Pa]
  double softening;         ///< zeta  [-]
  double friction;          ///< tan phi_sc after rupture  [-]

  /// @param transverse  K_tr = E_c S / D_B  [N/m]
  /// @param area        S, share of the bar's surface  [m2]
  /// @param touching    R_a + R_b  [m]
  /// @param axis        unit vector along the bar at a
  /// @param motion      of the pair; slip and normal parts together make the motion at the contact
  /// point
  /// @param approach    relative displacement of b along n in this step  [m]
  BR_HD InterfaceResponse answer(double transverse, double area, double touching, const Vec3& axis,
                                 const PairMotion<double>& motion, double approach,
                                 InterfaceState& state) const {
    InterfaceResponse r{};
    if (state.opening < 0.5 * (link_broken + link_released)) return r;
    const Vec3 radial = motion.normal - dot(motion.normal, axis) * axis;
    const double sine = norm(radial);
    const bool has_side = sine > 1e-3;  // b lies beside the bar, not on its axis
    const Vec3 out = has_side ? (1.0 / sine) * radial : Vec3{};
    const Vec3 round = cross(axis, out);
    const Vec3 moved = motion.slip + approach * motion.normal;

    // Radial.
    const TensionSoftening<double> tension{transverse, tensile_strength * area, softening};
    state.gap += dot(moved, out);
    const double u = state.gap;
    bool intact = state.opening >= 0.0;
    double radial_force = transverse * u;  // tension positive
    if (intact) {
      state.opening = larger(state.opening, u);
      if (transverse * state.opening >= tension.strength) {  // at the onset or beyond
        if (state.opening >= tension.rupture()) {
          intact = false;
          r.broke += tension.toughness();
          state.opening = link_broken;
        } else if (u > 0.0) {
          radial_force *= 1.0 - tension.damage(state.opening);
        }
      }
    }
    if (!intact && u > 0.0) radial_force = 0.0;
    if (!intact && u > 0.0 && motion.distance > 2.25 * touching) {
      r.slid = stored(transverse, area, state);
      state = {0.0, link_released, 0.0, 0.0, 0.0, 0.0};
      return r;
    }

    // Along and around the bar.
    const double slip_stiffness = slip_ratio * transverse;
    const double step = dot(moved, axis);
    state.slip += step;
    state.slip_peak = larger(state.slip_peak, absolute(state.slip));
    const double grip = larger(0.0, -friction * radial_force);
    const double bond_limit = intact ? area * bond.stress(state.slip_peak) : grip;
    r.slid += advance(state.along, slip_stiffness, step, bond_limit);
    const double around_limit = intact ? 1e300 : grip;
    r.slid += advance(state.around, transverse, has_side ? dot(moved, round) : 0.0, around_limit);

    r.force = state.along * axis + state.around * round - radial_force * out;
    r.active = intact || u < 0.0 ? 1.0 : 0.0;
    return r;
  }

  /// Energy a link stores.  [J]
  BR_HD double stored(double transverse, double area, const InterfaceState& state) const {
    const double u = state.gap;
    const TensionSoftening<double> tension{transverse, tensile_strength * area, softening};
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
    const TensionSoftening<double> tension{transverse, tensile_strength * area, softening};
    return state.opening >= 0.0 ? tension.spent(state.opening) : 0.0;
  }

 private:
  /// Elastic step of a force on b, cut at its limit; returns the energy spent.
  BR_HD static double advance(double& force, double stiffness, double step, double limit) {
    const double before = force;
    const double trial = before - stiffness * step;
    force = larger(-limit, smaller(limit, trial));
    if (force == trial) return 0.0;
    return 0.5 * (before + force) * (trial - force) / stiffness;
  }
};

}  // namespace breccia::dem
