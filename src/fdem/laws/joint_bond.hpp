#pragma once
// The cohesive joint between two triangles: combined single and smeared crack model.

#include <cstdint>

#include "math/vec2.hpp"

namespace breccia::fdem {

/// 1 over the integral of the softening curve: with it a joint dissipates exactly its fracture
/// energy. The literature's 3 gives 15.9 % more (docs/theory-fdem.md, 2).
inline constexpr double exact_softening_factor = 2.588612779530447;

/// A number of this size with the sign of another one: copysign(), of packs, too.
template <class R>
BR_HD R signed_as(const R& size, const R& other) {
  if constexpr (width_of<R> == 1) {
    return copysign(size, other);
  } else {
    typename TypesOf<R>::Bits bits, of_other;
    __builtin_memcpy(&bits, &size, sizeof bits);
    __builtin_memcpy(&of_other, &other, sizeof of_other);
    constexpr std::uint64_t sign = std::uint64_t{1} << 63;
    bits = (bits & ~sign) | (of_other & sign);
    R result;
    __builtin_memcpy(&result, &bits, sizeof result);
    return result;
  }
}

/// exp(-t) for 0 <= t <= 4, to 1e-15: only + and *, so that every machine gives the same bits.
template <class R>
BR_HD R decay(const R& t) {
  const R x = -0.125 * t;  // |x| <= 1/2
  R series = constant<R>(1.0);
  // Taylor's series by Horner: 0.5^14 / 14! < 1e-15
  for (int k = 13; k >= 1; --k) series = 1.0 + (1.0 / static_cast<double>(k)) * (x * series);
  const R two = series * series, four = two * two;
  return four * four;
}

/// z(D): share of its strength that a joint keeps at damage D in [0, 1] (Munjiza 2004, 7.12; fit of
/// Evans and Marathe 1968): 1 at 0, exactly 0 at 1.
template <class R>
BR_HD R softening(const R& damage) {
  constexpr double a = 0.63, b = 1.8, c = 6.0;
  constexpr double ratio = (a + b - 1.0) / (a + b);
  constexpr double rate = (a + c * b) / ((a + b) * (a + b - 1.0));  // of the decay
  const R left = 1.0 - damage, square = left * left;
  return (1.0 - ratio * decay(rate * damage)) * (a * left + b * square * square * square);
}

/// Strength of the joints of a pair of materials. Twelve numbers side by side: packs gather them.
template <class R>
struct BondOf {
  R stiffness;        ///< p_f, initial tangent times length  [Pa]
  R tension;          ///< f_t  [Pa]
  R cohesion;         ///< c  [Pa]
  R friction;         ///< tan phi_i  [-]
  R softening_open;   ///< o_t f_t = factor G_I  [J/m2]
  R softening_slide;  ///< s_t f_s = factor G_II  [J/m2]
  R reversible;       ///< 1: unloading goes back along the curve, as in the classical codes, which
                      ///< heals and can create energy; 0: along the secant  [-]
  R residual;         ///< tan phi_r <= tan phi_i: friction kept while a pressed joint softens  [-]
  R young{};          ///< E' of the rock beside it, in its plane; 0: the joint fails by its own
                      ///< tractions alone, as edges do  [Pa]
  R poisson{};        ///< nu' of that rock, in its plane  [-]
  R skew{};           ///< of bedded rock: stress along the edge by a shear of 1 Pa  [-]
  R unused{};

  BR_HD auto by_rock() const { return young > 0.0; }
};
using JointBond = BondOf<double>;

/// How the rock failed at a joint (laws/rock_failure.hpp). none: it has not.
enum class Failure : std::uint8_t { none, torn, sheared };

/// State of an integration point. The last five are those of failure with the rock, 0 before: a
/// joint may have softened by then, so that they do not follow from its law and the others.
template <class R>
struct BondState {
  R damage;   ///< largest D so far  [-]
  R opening;  ///< largest opening so far; 0 until it exceeds the elastic limit  [m]
  R slip;     ///< largest |slip| so far; 0 until it exceeds the elastic limit  [m]
  R normal;   ///< torn: sigma_0, what it carried; sheared: 0  [Pa]
  R shear;    ///< torn: tau_0, what it carried; sheared: c_0, without friction  [Pa]
  R opened;   ///< torn: its opening then, o_0  [m]
  R slid;     ///< torn: its |slip| then, s_0  [m]; sheared: |slip| of yield over strength  [m/Pa]
  R stuck;    ///< torn: slip at which its friction pulls with nothing  [m]
};
BR_HD inline Failure failure_of(const BondState<double>& state) {
  return state.normal > 0.0 ? Failure::torn : state.shear > 0.0 ? Failure::sheared : Failure::none;
}

/// Tractions at an integration point.
template <class R>
struct BondTraction {
  R normal;  ///< sigma, tension positive  [Pa]
  R shear;   ///< tau, with the sign of the slip  [Pa]
};

/// Law of one integration point (docs/theory-fdem.md, 2):
///
///   opening o < 0     sigma = p_f o / h, without limit and never degraded
///   o <= o_p          sigma = z f_t (2 r - r^2), r = o / o_p, o_p = 2 h f_t / p_f
///   beyond            sigma = z f_t, and on the secant to the largest opening when it closes
///   shear             the same with f_s = c - min(sigma, 0) tan phi and s_p = 2 h f_s / p_f, but
///                     z f_s - (1 - z) min(sigma, 0) tan phi_r in place of z f_s
///   damage            D = |((o - o_p) / o_t, (|s| - s_p) / s_t)| of the positive parts,
///                     o_t = factor G_I / f_t, s_t = factor G_II / f_s; broken at D = 1
///
/// f_s is that of the same point and step. Until a point goes beyond o_p or s_p it answers by this:
///
/// @param slope  p_f / h  [Pa/m]  @param tension, cohesion  of this joint  [Pa]
/// @param quarter  1 / (4 tension)  [1/Pa]
/// @param beyond  set where the point leaves its elastic branch, so that the response does not hold
template <class R, class Mask>
BR_HD BondTraction<R> elastic_response(const R& slope, const R& tension, const R& quarter,
                                       const R& cohesion, const R& friction, const R& opening,
                                       const R& slip, Mask& beyond) {
  const R straight = slope * opening, sideways = slope * slip;
  const auto pressed = straight < 0.0;
  const R strength = cohesion - select(pressed, friction * straight, constant<R>(0.0));
  const R size = abs(sideways);
  beyond = beyond || straight > 2.0 * tension || size > 2.0 * strength;
  // f (2 r - r^2) with r = slope x / (2 f). Nothing that may be zero is divided: GPUs are slow at
  // it
  return {select(pressed, straight, straight * (1.0 - straight * quarter)),
          sideways * (1.0 - size * (0.25 / strength))};
}

/// From this |tau|/f_s on a joint that stays whole books what pressure takes on its slip: below it,
/// that is at most |tau|/(6 f_s) of what its slip stores.  [-]
inline constexpr double least_drag = 0.2;
/// Work beyond what a point of a whole joint stores in a step: at the strength f in shear a slip of
/// the elastic traction T = p_f s/h stores W = h/p_f (T^2/2 - T^3/(12 f)), and f follows the
/// pressure, which does no work of its own on the slip. It is -dW/df df, whatever its sign.  [J/m2]
/// @param opening, slip  at the beginning of the step and at its end  [m]
template <class R>
BR_HD R spent_by_pressure(const R& slope, const R& cohesion, const R& friction,
                          const R (&opening)[2], const R (&slip)[2]) {
  const R zero = constant<R>(0.0), one = constant<R>(1.0);
  R less[2], cube = zero;
  auto bears = one > zero;  // any slip
  for (int n = 0; n < 2; ++n) {
    const R strength = cohesion - friction * slope * min(opening[n], zero);
    bears = bears && strength > 0.0;
    less[n] = 1.0 / select(strength > 0.0, strength, one);
    const R size = slope * abs(slip[n]);
    cube = cube + 0.5 * (size * size * size);
  }
  return select(bears, cube / (12.0 * slope) * (less[1] - less[0]), zero);
}

/// The law in full while the rock has not failed. @param strength  of this joint over its law's:
/// scales f_t, c and, so that lengths stay, both energies  [-]. @param h  initial length  [m]
template <class R>
BR_HD BondTraction<R> edge_response(const BondOf<R>& law, const R& strength, const R& h,
                                    const R& opening, const R& slip, BondState<R>& state) {
  const R zero = constant<R>(0.0), one = constant<R>(1.0);
  const R tension = law.tension * strength;
  const auto pressed = opening < 0.0;
  const R pressure = (law.stiffness / h) * opening;  // sigma where pressed
  const R shear_strength = law.cohesion * strength - select(pressed, law.friction * pressure, zero);
  const R o_p = (2.0 / law.stiffness) * h * tension;
  const R s_p = (2.0 / law.stiffness) * h * shear_strength;
  const R slid = abs(slip);
  const R over_o = max(zero, opening - o_p), over_s = max(zero, slid - s_p);

  // Damage.
  R health = one;
  const auto reversible = law.reversible > 0.5;
  const auto softens = over_o > 0.0 || over_s > 0.0 || state.damage > 0.0;
  if (any(softens)) {
    const R open = over_o * (tension / (law.softening_open * strength));
    const R slide = over_s * (shear_strength / (law.softening_slide * strength));
    const R now = min(one, sqrt(open * open + slide * slide));
    state.damage = max(state.damage, now);
    health = select(softens, softening(select(reversible, now, state.damage)), one);
  }
  const auto one_way = !reversible;
  state.opening = select(one_way && over_o > 0.0, max(state.opening, opening), state.opening);
  state.slip = select(one_way && over_s > 0.0, max(state.slip, slid), state.slip);

  // Tractions.
  BondTraction<R> t;
  const R r = opening / select(o_p > zero, o_p, one);
  R pull = select(opening <= o_p, 2.0 * r - r * r, one);
  pull =
      select(state.opening > 0.0, opening / select(state.opening > 0.0, state.opening, one), pull);
  t.normal = select(pressed, pressure, health * tension * pull);
  const R q = slid / select(s_p > zero, s_p, one);
  R drag = select(slid <= s_p, 2.0 * q - q * q, one);
  const R reach = max(state.slip, s_p);
  drag = select(state.slip > 0.0, min(one, slid / select(reach > zero, reach, one)), drag);
  const R friction = select(pressed, -law.residual * pressure, zero);
  const R size = (health * shear_strength + (one - health) * friction) * drag;
  t.shear = select(slip < 0.0, -size, size);
  return t;
}

/// Of the shear traction of a point whose state follows from its opening and slip, what residual
/// friction bears, (1 - z) |sigma| tan phi_r at full slip, with the sign of the slip.  [Pa]
template <class R>
BR_HD R edge_friction(const BondOf<R>& law, const R& strength, const R& h, const R& opening,
                      const R& slip, const BondState<R>& state) {
  const R zero = constant<R>(0.0), one = constant<R>(1.0);
  const auto rubs = opening < 0.0 && state.damage > 0.0;
  if (!any(rubs)) return zero;
  const R pressure = (law.stiffness / h) * opening, slid = abs(slip);
  const R shear_strength = law.cohesion * strength - law.friction * pressure;
  const R s_p = (2.0 / law.stiffness) * h * shear_strength;
  R damage = state.damage;
  const auto reversible = law.reversible > 0.5;
  if (any(reversible))
    damage =
        select(reversible,
               min(one, max(zero, slid - s_p) * shear_strength / (law.softening_slide * strength)),
               damage);
  const R q = slid / select(s_p > zero, s_p, one), reach = max(state.slip, s_p);
  R drag = select(slid <= s_p, 2.0 * q - q * q, one);
  drag = select(state.slip > 0.0, min(one, slid / select(reach > zero, reach, one)), drag);
  return select(rubs, signed_as((1.0 - softening(damage)) * -law.residual * pressure * drag, slip),
                zero);
}

/// Energy that a point would give back, by direction.  [J/m2]
struct StoredEnergy {
  double open, slide;
  double rubs = 0.0;  ///< of slide, what residual friction holds
};
/// Of (2 r - r^2) f, r = x / p, up to p.
template <class R>
BR_HD inline R stored_on_parabola(const R& f, const R& x, const R& p) {
  const auto rises = p > 0.0;
  const R r = min(x, p) / select(rises, p, constant<R>(1.0));
  return select(rises, f * p * (r * r - r * r * r / 3.0), constant<R>(0.0));
}
/// By opening and by slip.
template <class R>
struct StoredUndamaged {
  R open, slide;
};
/// Of a point that has no damage: on its rising branches, or pressed.
/// @param tension, cohesion  of this joint  [Pa]  @param h  its length  [m]
template <class R>
BR_HD StoredUndamaged<R> stored_undamaged(const R& stiffness, const R& tension, const R& cohesion,
                                          const R& friction, const R& h, const R& opening,
                                          const R& slip) {
  const auto pressed = opening < 0.0;
  const R pressure = select(pressed, stiffness * opening / h, constant<R>(0.0));
  const R shear = cohesion - friction * pressure;
  const R o_p = 2.0 * h * tension / stiffness, s_p = 2.0 * h * shear / stiffness;
  return {select(pressed, 0.5 * pressure * opening, stored_on_parabola<R>(tension, opening, o_p)),
          stored_on_parabola<R>(shear, abs(slip), s_p)};
}
/// If it were unloaded now.
BR_HD inline StoredEnergy edge_stored(const JointBond& law, double strength, double h,
                                      double opening, double slip, const BondState<double>& state) {
  const double tension = law.tension * strength, o_p = 2.0 * h * tension / law.stiffness;
  if (!(state.damage > 0.0 || state.opening > 0.0 || state.slip > 0.0)) {
    const StoredUndamaged<double> whole = stored_undamaged<double>(
        law.stiffness, tension, law.cohesion * strength, law.friction, h, opening, slip);
    return {whole.open, whole.slide, 0.0};
  }
  const double pressure = opening < 0.0 ? law.stiffness * opening / h : 0.0;
  const double shear = law.cohesion * strength - law.friction * pressure;
  const double s_p = 2.0 * h * shear / law.stiffness;
  const double z = state.damage > 0.0 ? softening(state.damage) : 1.0, slid = abs(slip);
  const double kept = z * shear - (1.0 - z) * law.residual * pressure;
  StoredEnergy energy{};
  if (opening < 0.0)
    energy.open = 0.5 * pressure * opening;
  else if (state.opening > 0.0)
    energy.open = 0.5 * z * tension * opening * opening / state.opening;
  else
    energy.open = z * stored_on_parabola(tension, opening, o_p);
  if (state.slip > 0.0) {
    const double reach = max(state.slip, s_p), used = min(slid, reach);
    energy.slide = 0.5 * kept * used * used / reach;
  } else {
    energy.slide = stored_on_parabola(kept, slid, s_p);
  }
  if (kept > 0.0) energy.rubs = energy.slide * ((1.0 - z) * law.residual * -pressure / kept);
  return energy;
}

}  // namespace breccia::fdem
