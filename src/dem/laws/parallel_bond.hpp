#pragma once
// A bond of cement between two grains: the parallel bond of particle flow codes.

#include "dem/laws/pair_motion.hpp"
#include "math/constants.hpp"

namespace breccia::dem {

/// State of a parallel bond from step to step.
template <class R>
struct ParallelBondStateOf {
  R bond;            ///< 1 while it holds, 0 once broken, bond_released when its ends have parted
  R strained;        ///< largest stress over strength so far  [-]
  Vec3Of<R> shear;   ///< F_s on b, world frame  [N]
  Vec3Of<R> moment;  ///< M on b, world frame  [N m]
};
using ParallelBondState = ParallelBondStateOf<double>;
inline constexpr double bond_released = -1.0;

/// Response of a parallel bond in one step.
template <class R>
struct ParallelBondResponseOf {
  R normal;          ///< N, tension positive  [N]
  Vec3Of<R> shear;   ///< F_s on b  [N]
  Vec3Of<R> moment;  ///< M on b  [N m]
  R active;          ///< 1 where it resists, 0 where not  [-]
  R slid;            ///< energy spent on sliding after rupture in this step  [J]
  R broke;           ///< energy spent by rupture in this step  [J]
};

/// A disc of cement of radius lambda min(R_a, R_b) across the contact, elastic until it breaks as a
/// whole (Potyondy and Cundall 2004, A bonded-particle model for rock, section 2.1).
///
///   whole   N = K_n u,  F_s += -K_s du_s,  M_b += -K_n I/A dtheta_b,  M_t += -K_s J/A dtheta_t
///   breaks  when sigma = N/A + beta |M_b| R/I reaches sigma_c,
///           or tau = |F_s|/A + beta |M_t| R/J reaches c - (N/A) tan phi
///   broken  compression K_n u against its free length, friction mu_b, no moments; parted for good
///           beyond 1.5 times the larger of that length and R_a + R_b
///
/// K_n and its free length are those of the link, K_s = ratio K_n.
struct ParallelBond {
  double tensile_strength;  ///< sigma_c  [Pa]
  double cohesion;          ///< c  [Pa]
  double friction;          ///< tan phi of the bond  [-]
  double broken_friction;   ///< mu_b  [-]
  double shear_ratio;       ///< K_s / K_n  [-]
  double radius_factor;     ///< lambda  [-]
  double moment_share;      ///< beta: how far moments count in the stresses  [-]

  /// Of one bond.
  template <class R>
  struct ConstantsOf {
    R length;     ///< at which it is free of force  [m]
    R stiffness;  ///< K_n  [N/m]
    R radius;     ///< of the disc  [m]
    R touching;   ///< R_a + R_b  [m]
    R strength;   ///< sigma_c and c over those of the law: bedding  [-]
    BR_HD R area() const { return pi * radius * radius; }
    BR_HD R bending() const { return 0.25 * stiffness * radius * radius; }  ///< K_n I/A  [N m]
  };
  using Constants = ConstantsOf<double>;
  template <class R>
  BR_HD ConstantsOf<R> constants(const R& length, const R& stiffness, const R& strength,
                                 const R& radius_a, const R& radius_b) const {
    return {length, stiffness, radius_factor * min(radius_a, radius_b), radius_a + radius_b,
            strength};
  }
  /// K_s J/A.  [N m]
  template <class R>
  BR_HD R twisting(const ConstantsOf<R>& k) const {
    return 2.0 * shear_ratio * k.bending();
  }

  /// One step of bonds that hold and stay whole.
  /// @returns false, having done nothing, if one is broken or breaks
  template <class R>
  BR_HD bool stays_whole(const ConstantsOf<R>& k, const PairMotion<R>& motion,
                         ParallelBondStateOf<R>& state, ParallelBondResponseOf<R>& r) const {
    const Trial<R> t = trial(k, motion, state);
    if (any(state.bond < 0.5 || !(t.strained < 1.0))) return false;
    const R none = constant<R>(0.0);
    state.strained = max(state.strained, t.strained);
    state.shear = t.shear;
    state.moment = t.bend + t.twist;
    r = {t.normal, state.shear, state.moment, constant<R>(1.0), none, none};
    return true;
  }
  /// One step of any bond.
  BR_HD ParallelBondResponseOf<double> response(const Constants& k,
                                                const PairMotion<double>& motion,
                                                ParallelBondState& state) const {
    ParallelBondResponseOf<double> r{};
    if (state.bond < 0.0 || stays_whole(k, motion, state, r)) return r;
    const double stretch = motion.distance - k.length;
    if (state.bond < 0.5 && motion.distance > 1.5 * max(k.length, k.touching)) {
      state = {bond_released, state.strained, {}, {}};
      return r;
    }
    const Trial<double> t = trial(k, motion, state);
    const bool breaks = state.bond > 0.5;
    // Compression and friction are left.
    r.normal = stretch < 0.0 ? k.stiffness * stretch : 0.0;
    r.active = stretch < 0.0 ? 1.0 : 0.0;
    const double limit = -broken_friction * r.normal, size = norm(t.shear);
    r.shear = size > limit ? (limit / size) * t.shear : t.shear;
    const double ks = shear_ratio * k.stiffness;
    const Vec3 both = 0.5 * (t.shear_before + r.shear);
    if (breaks) {
      // Energy stored before and given by the trapezoidal rule, less the energy that stays stored.
      const ParallelBondState before{1.0, 0.0, t.shear_before, t.bend_before + t.twist_before};
      const ParallelBondState after{0.0, 0.0, r.shear, {}};
      const double last = stretch - motion.extension;
      r.broke = stored(k, motion.normal, last, before) - stored(k, motion.normal, stretch, after) +
                0.5 * (k.stiffness * last + r.normal) * motion.extension +
                dot(both, t.shear - t.shear_before) / ks +
                0.5 * dot(t.bend_before, t.bend - t.bend_before) / k.bending() +
                0.5 * dot(t.twist_before, t.twist - t.twist_before) / twisting(k);
    } else {
      r.slid = dot(both, t.shear - r.shear) / ks;
    }
    state = {0.0, max(state.strained, breaks ? t.strained : 0.0), r.shear, {}};
    return r;
  }

  /// Energy that a bond stores.  [J]
  BR_HD double stored(const Constants& k, const Vec3& normal, double stretch,
                      const ParallelBondState& state) const {
    if (state.bond < 0.0) return 0.0;
    const double along = state.bond > 0.5 || stretch < 0.0 ? stretch : 0.0;
    const double twist = dot(state.moment, normal);
    const double bend = dot(state.moment, state.moment) - twist * twist;
    return 0.5 * k.stiffness * along * along +
           dot(state.shear, state.shear) / (2.0 * shear_ratio * k.stiffness) +
           bend / (2.0 * k.bending()) + twist * twist / (2.0 * twisting(k));
  }

 private:
  /// Forces and moments after a step of elastic motion.
  template <class R>
  struct Trial {
    R normal;
    Vec3Of<R> shear_before, bend_before, twist_before;  ///< carried with the pair
    Vec3Of<R> shear, bend, twist;                       ///< and with this step's increment
    R strained;                                         ///< stress over strength  [-]
  };
  template <class R>
  BR_HD Trial<R> trial(const ConstantsOf<R>& k, const PairMotion<R>& motion,
                       const ParallelBondStateOf<R>& state) const {
    Trial<R> t;
    t.normal = k.stiffness * (motion.distance - k.length);
    t.shear_before = motion.tangential(motion.rotated_with_pair(state.shear));
    t.shear = t.shear_before - (shear_ratio * k.stiffness) * motion.slip;
    const Vec3Of<R> moment = motion.rotated_with_pair(state.moment);
    const Vec3Of<R> turned = dot(motion.turn, motion.normal) * motion.normal;
    t.bend_before = motion.tangential(moment);
    t.twist_before = dot(moment, motion.normal) * motion.normal;
    t.bend = t.bend_before - k.bending() * (motion.turn - turned);
    t.twist = t.twist_before - twisting(k) * turned;
    // R/I = 4/(A R), R/J = 2/(A R)
    const R area = k.area(), share = moment_share / (area * k.radius);
    const R pull = t.normal / area;
    const R tension = pull + 4.0 * share * norm(t.bend);
    const R sliding = norm(t.shear) / area + 2.0 * share * norm(t.twist);
    const R bears = max(cohesion * k.strength - friction * pull, constant<R>(1e-300));
    t.strained = max(tension / (tensile_strength * k.strength), sliding / bears);
    return t;
  }
};

}  // namespace breccia::dem
