#pragma once
// The cohesive link of concrete: modified Mohr-Coulomb with softening and moment transfer.

#include "dem/laws/pair_motion.hpp"
#include "dem/laws/tension_softening.hpp"

namespace breccia::dem {

/// What a link keeps from step to step.
template <class R>
struct LinkState {
  R opening;         ///< largest opening so far, >= 0; link_broken or link_released afterwards  [m]
  Vec3Of<R> shear;   ///< F_s on b, world frame  [N]
  Vec3Of<R> moment;  ///< M on b, world frame  [N m]
};
inline constexpr double link_broken =
    -1.0;  ///< LinkState::opening of a link that answers as a contact
inline constexpr double link_released = -2.0;  ///< ... of a link whose ends have parted for good

/// What a law answers in one step.
template <class R>
struct LinkResponse {
  R normal;          ///< N, tension positive  [N]
  Vec3Of<R> shear;   ///< F_s on b  [N]
  Vec3Of<R> moment;  ///< M on b  [N m]
  R active;          ///< 1 where the link resists, 0 where it does not: share of its stiffness  [-]
  R slid;            ///< energy spent on sliding in this step  [J]
  R yielded;         ///< energy spent on plastic moments in this step  [J]
  R broke;           ///< energy that the rupture spent, 0 unless the link broke in this step  [J]
};

/// Constants of one link.
template <class R>
struct LinkConstants {
  R length;     ///< D_eq, at which it is free of force  [m]
  R stiffness;  ///< K_n  [N/m]
  R area;       ///< S = pi min(R_a, R_b)^2  [m2]
  R radius;     ///< r, mean of the two  [m]
  R touching;   ///< R_a + R_b  [m]
};

/// Cohesive link and, after rupture, the contact that is left of it (docs/theory.md, cohesive
/// links).
///
///   tension      N = K_n u                     up to the opening u_1 = S T / K_n
///                N = S T - (K_n / zeta)(u-u_1) up to u_2 = u_1 (1 + zeta), then rupture
///                unloading along the secant to the largest opening; compression K_n u without
///                limit
///   shear        F_s += -K_t du_s, cut at S C (1 - damage) - N tan phi
///   moment       M += -K_r dtheta, cut at eta r (|N| in compression + S T (1 - damage))
///   after rupture compression against D_eq, friction tan phi_c, no cohesion; parted for good
///   beyond
///                1.5 times the larger of D_eq and R_a + R_b
///
/// Tension and opening are positive. Shear force and moment act on b; a gets the opposite.
/// Source: Durand 2012, section 2; law of the Rousseau 2008 family, completed in docs/theory.md.
struct ConcreteLink {
  double tensile_strength;  ///< T  [Pa]
  double cohesion;          ///< C  [Pa]
  double softening;         ///< zeta >= 0  [-]
  double friction;          ///< tan phi_i of the intact link  [-]
  double broken_friction;   ///< tan phi_c  [-]
  double shear_ratio;       ///< K_t / K_n  [-]
  double rolling_ratio;     ///< beta_r = K_r / (K_t r^2)  [-]
  double rolling_limit;     ///< eta  [-]
  double brittle_shear;     ///< 1: a link breaks at its shear strength; 0: it slides on  [-]

  template <class R>
  BR_HD LinkResponse<R> answer(const LinkConstants<R>& link, const PairMotion<R>& motion,
                               LinkState<R>& state) const {
    const R zero = constant<R>(0.0), one = constant<R>(1.0);
    const R kn = link.stiffness, kt = shear_ratio * kn;
    const R kr = rolling_ratio * kt * link.radius * link.radius;
    const R strength = tensile_strength * link.area;  // S T
    const TensionSoftening<R> tension{kn, strength, softening};
    const R u = motion.distance - link.length;
    const R opening_before = state.opening;
    const auto intact = opening_before >= 0.0;
    const auto released_before = opening_before < 0.5 * (link_broken + link_released);

    // 1. Normal force.
    const R opening = larger(opening_before, u);
    const auto torn = both(intact, kn * opening >= strength * (1.0 + softening));
    R health = one;  // 1 - damage
    const auto softened_now = both(intact, kn * opening > strength);
    if (any(softened_now)) health = choose(softened_now, one - tension.damage(opening), one);
    const auto pressed = u < 0.0;
    const auto holds = both(intact, opposite(torn));
    const auto parted =
        either(released_before,
               both(opposite(intact), motion.distance > 1.5 * larger(link.length, link.touching)));
    const auto resists = either(holds, both(pressed, opposite(parted)));
    const R elastic = kn * u;
    const R normal = choose(resists, choose(pressed, elastic, health * elastic), zero);

    // 2. Shear force and moment: carried with the pair, then this step's increment.
    const Vec3Of<R> shear_before = motion.across(motion.carried(state.shear));
    const Vec3Of<R> moment_before = motion.carried(state.moment);
    const Vec3Of<R> shear_trial = shear_before - kt * motion.slip;
    const Vec3Of<R> moment_trial = moment_before - kr * motion.turn;

    // 3. Their limits.
    const R cohesive = choose(holds, health, zero);
    const R slope = choose(holds, constant<R>(friction), constant<R>(broken_friction));
    R shear_limit = larger(zero, cohesion * link.area * cohesive - normal * slope);
    const R shear_squared = dot(shear_trial, shear_trial);
    auto sheared = both(holds, shear_squared > zero);
    sheared = both(sheared, shear_squared > shear_limit * shear_limit);
    sheared = both(sheared, constant<R>(brittle_shear) > 0.5);
    if (any(sheared))
      shear_limit = choose(sheared, larger(zero, -1.0 * broken_friction * normal), shear_limit);
    const auto survives = both(holds, opposite(sheared));
    const auto acts = either(survives, both(pressed, opposite(parted)));
    const R moment_limit = rolling_limit * link.radius *
                           (choose(either(pressed, opposite(survives)), absolute(normal), zero) +
                            choose(survives, strength * health, zero));

    LinkResponse<R> r;
    r.normal = choose(acts, normal, zero);
    r.slid = zero;
    r.yielded = zero;
    r.broke = zero;
    r.active = choose(acts, one, zero);
    const auto slides = either(shear_squared > shear_limit * shear_limit, opposite(acts));
    r.shear = shear_trial;
    if (any(slides)) {
      const R size = root(shear_squared);
      const R scale = choose(acts, shear_limit / choose(size > zero, size, one), zero);
      r.shear = choose(slides, scale * shear_trial, shear_trial);
      const R per_stiffness = constant<R>(0.5) / choose(kt > zero, kt, one);
      r.slid = per_stiffness * dot(shear_before + r.shear, shear_trial - r.shear);
    }
    const R moment_squared = dot(moment_trial, moment_trial);
    const auto rolls = either(moment_squared > moment_limit * moment_limit, opposite(acts));
    r.moment = moment_trial;
    if (any(rolls)) {
      const R size = root(moment_squared);
      const R scale = choose(acts, moment_limit / choose(size > zero, size, one), zero);
      r.moment = choose(rolls, scale * moment_trial, moment_trial);
      const R per_stiffness = constant<R>(0.5) / choose(kr > zero, kr, one);
      r.yielded = per_stiffness * dot(moment_before + r.moment, moment_trial - r.moment);
    }

    // 4. What is kept.
    const auto ends = either(torn, sheared);
    state.opening = choose(intact, opening, opening_before);
    if (any(ends)) {
      const R spent = choose(
          torn, tension.toughness(),
          tension.spent(opening) + choose(pressed, zero, constant<R>(0.5) * health * kn * u * u));
      r.broke = choose(ends, spent + r.slid + r.yielded, zero);
      r.slid = choose(ends, zero, r.slid);
      r.yielded = choose(ends, zero, r.yielded);
      state.opening = choose(ends, constant<R>(link_broken), state.opening);
    }
    state.opening = choose(parted, constant<R>(link_released), state.opening);
    state.shear = r.shear;
    state.moment = r.moment;
    return r;
  }

  BR_HD TensionSoftening<double> tension(const LinkConstants<double>& link) const {
    return {link.stiffness, tensile_strength * link.area, softening};
  }
  /// N of a link at a stretch u, tension positive.  [N]
  BR_HD double normal_force(const LinkConstants<double>& link, double stretch,
                            double opening) const {
    const double elastic = link.stiffness * stretch;
    if (opening < 0.5 * (link_broken + link_released)) return 0.0;
    if (stretch < 0.0) return elastic;
    return opening >= 0.0 ? (1.0 - tension(link).damage(opening)) * elastic : 0.0;
  }
  /// Energy a link stores at a stretch u.  [J]
  BR_HD double stored(const LinkConstants<double>& link, double stretch,
                      const LinkState<double>& state) const {
    const double kn = link.stiffness, kt = shear_ratio * kn;
    const double kr = rolling_ratio * kt * link.radius * link.radius;
    const bool intact = state.opening >= 0.0;
    if (state.opening < 0.5 * (link_broken + link_released)) return 0.0;
    double energy = 0.0;
    if (stretch < 0.0)
      energy = 0.5 * kn * stretch * stretch;
    else if (intact)
      energy = 0.5 * kn * (1.0 - tension(link).damage(state.opening)) * stretch * stretch;
    if (kt > 0.0) energy += dot(state.shear, state.shear) / (2.0 * kt);
    if (kr > 0.0) energy += dot(state.moment, state.moment) / (2.0 * kr);
    return energy;
  }
};

}  // namespace breccia::dem
