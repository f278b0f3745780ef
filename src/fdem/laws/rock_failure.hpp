#pragma once
// Failure of the rock at a joint (joints.criterion = "rock"): a joint of a free mesh fails where
// the stress of the rock beside it fails on any plane near its edge, with the traction it then
// carries.
//
// Derivation (docs/theory-fdem.md, 2.1; Breccia's own). By its own tractions alone an edge inclined
// by theta to the plane of largest tension sigma_1 fails where sigma_1 cos^2 theta = f_t, and bears
// shear up to c besides: on a free mesh strength is f_t/(0.9135 + 0.0865 sigma_2/sigma_1) and grows
// with c. A crack that follows edges is, over its length, one in the plane of largest tension. So
// the criterion is Rankine's and Mohr and Coulomb's for the rock, not for the edge, and the
// traction vector fades as one:
//   criterion  from sigma_n, tau (means over the joint) and sigma_l (along the edge, from its
//   stretch) torn       sigma = z(D) sigma_0 o/o_m, |tau| = z(D) tau_0 |s|/s_m  [Pa],
//              D = |(<o - o_0>, <|s| - s_0>)|/o_t  [-]
//   sheared    as by its own tractions with c_0 = |tau_0| + min(sigma_0, 0) tan phi for c  [Pa],
//              but friction sticks and slips
// In uniaxial tension (sigma_0, tau_0) = f_t cos theta (cos theta, sin theta): a vector of f_t per
// length across the tension, along the tension; opened along it, it takes G_I per that length,
// whatever theta.

#include "fdem/laws/joint_bond.hpp"

namespace breccia::fdem {

/// cos^2 35 degrees. In a free mesh an edge lies within 30 degrees of any direction; 5 more for
/// triangles that are not equilateral. So near, sigma_1 counts in full.
inline constexpr double torn_in_full = 0.6710100716628344;
/// cos^2 60 degrees. From 35 degrees on sigma_1 counts less, as cos^2 theta; beyond 60, where
/// another edge of the triangle must lie nearer, the joint does not tear for it.
inline constexpr double torn_at_all = 0.25;
/// cos(2 x 25 degrees). Two planes can slide, 90 degrees - phi apart: of edges 60 degrees apart one
/// lies within 25 of one of both nearly everywhere. 35 changed nothing in compression tests.
inline constexpr double sheared_at_all = 0.6427876096865394;

/// Stress of the rock at a joint, tension positive.  [Pa]
template <class R>
struct RockStressOf {
  R normal, shear, along;  ///< across the edge, in it, and along it
};
using RockStress = RockStressOf<double>;

/// Stress along an edge from its stretch, which both sides share:
///   sigma_l = E' (|e|/h - 1) + nu' (sigma_n - S0_nn) + skew (tau - S0_ln) + S0_ll
/// @param axis  e, unit vector  [-]  @param stretch  |e|/h - 1  [-]
/// @param normal, shear  sigma_n, tau  [Pa]
/// @param in_situ  S_0, taken along the present axis  [Pa]
template <class R, class Start>
BR_HD R stress_along(const Vec2Of<R>& axis, const R& stretch, const R& normal, const R& shear,
                     const R& young, const R& poisson, const R& skew, const Start& in_situ) {
  const R &x = axis.x, &y = axis.y;
  const R xx = x * x, yy = y * y, twice = 2.0 * in_situ.xy * x * y;
  const R start_along = in_situ.xx * xx + in_situ.yy * yy + twice;
  const R start_across = in_situ.xx * yy + in_situ.yy * xx - twice;
  const R start_shear = (in_situ.yy - in_situ.xx) * (x * y) + in_situ.xy * (xx - yy);
  return young * stretch + poisson * (normal - start_across) + skew * (shear - start_shear) +
         start_along;
}

/// Whether the rock can have failed on any plane at all: sigma_1 above f_t, or the circle beyond
/// c - sigma tan phi. Cheap, for packs; rock_failure says on which.
template <class R>
BR_HD auto may_fail(const R& tension, const R& cohesion, const R& friction, const R& normal,
                    const R& shear, const R& along) {
  const R centre = 0.5 * (normal + along), half = 0.5 * (normal - along);
  const R radius = sqrt(half * half + shear * shear);
  return centre + radius > tension ||
         friction * centre + radius * sqrt(1.0 + friction * friction) > cohesion;
}

/// Stress over strength.  [-]
template <class R>
struct RockFailureOf {
  R torn, sheared;
  BR_HD R most() const { return max(torn, sheared); }
};
using RockFailure = RockFailureOf<double>;

/// How far the rock is from failure on a plane near this edge. With theta between its normal and
/// the direction of sigma_1, C and radius those of Mohr's circle:
///   torn     sigma_n/f_t, or, if sigma_n > 0, sigma_1 min(1, cos^2 theta/cos^2 35 deg)/f_t
///   sheared  (C tan phi + radius/cos phi)/c, if the edge is within 25 degrees of a plane that
///   slides
template <class R>
BR_HD RockFailureOf<R> rock_failure(const BondOf<R>& law, const R& strength,
                                    const RockStressOf<R>& s) {
  const R zero = constant<R>(0.0), one = constant<R>(1.0);
  const R tension = law.tension * strength, cohesion = law.cohesion * strength;
  const R centre = 0.5 * (s.normal + s.along), half = 0.5 * (s.normal - s.along);
  const R radius = sqrt(half * half + s.shear * s.shear);
  RockFailureOf<R> f{s.normal / tension, zero};
  const auto differs = radius > 0.0;
  if (!any(differs)) return f;
  const R cos2 = 0.5 + 0.5 * half / select(differs, radius, one);  // of theta
  const auto tears = differs && s.normal > 0.0 && cos2 >= torn_at_all;
  if (any(tears))
    f.torn = select(tears, max(f.torn, (centre + radius) * min(one, cos2 / torn_in_full) / tension),
                    f.torn);
  const R reach = radius * sqrt(1.0 + law.friction * law.friction);
  const R middle = centre * law.friction;
  const R own = abs(s.shear) + s.normal * law.friction;  // less middle: reach cos(2 angle)
  const auto slides = differs && own > 0.0 && own - middle >= sheared_at_all * reach;
  if (any(slides))
    f.sheared = select(slides, (middle + reach) / select(slides, cohesion, one), zero);
  return f;
}

/// @returns none while both are below 1
BR_HD inline Failure failure_of(const RockFailure& f) {
  return f.torn >= 1.0 ? Failure::torn : f.sheared >= 1.0 ? Failure::sheared : Failure::none;
}

/// A point of a joint that fails with the rock: from now on it answers from what it carries, and
/// its force does not jump. If it had begun to soften it goes on with its z(D).
/// @param carried  its tractions now, by the law of edges  [Pa]
BR_HD inline void fail(const JointBond& law, double strength, double h, Failure how, double opening,
                       double slip, const BondTraction<double>& carried, BondState<double>& state) {
  const double unit = h / law.stiffness, slid = abs(slip), shear = abs(carried.shear);
  const double pressure = max(0.0, -carried.normal), z = softening(state.damage);
  state.damage = max(state.damage, 1e-12);  // it has begun
  if (how == Failure::torn) {
    // No less than a hundredth of f_t, so that nothing is divided by zero.
    const double least = 0.01 * law.tension * strength;
    const double most = pressure * (z * law.friction + (1.0 - z) * law.residual);
    const double rubs = min(most, shear);
    state.normal = max(carried.normal / z, least);
    state.shear = (shear - rubs) / z;
    state.stuck = slip - copysign(rubs * unit, slip);
    state.opening = state.opened = max(opening, unit * least);
    state.slip = state.slid = max(slid, 1e-4 * unit * least);
    return;
  }
  // Friction bears what it can, c_0 the rest, on the secant to where it is now.
  const double least = 0.02 * law.cohesion * strength;
  const double most = pressure * (z * law.friction + (1.0 - z) * law.residual);
  const double rubs = min(most, max(0.0, shear - z * least));
  state.normal = 0.0;
  state.shear = max((shear - rubs) / z, least);
  state.stuck = slip - copysign(rubs * unit, slip);
  state.slip = slid;
  if (shear < z * least) state.slip = shear > 0.0 ? slid * z * least / shear : unit * least;
  const double rest = (1.0 - z) * law.residual * pressure;
  const double resists = state.shear + law.friction * pressure;
  state.slid = shear > 0.0 ? (z + rest / resists) * slid / shear : unit;
}

/// Of a pressed point that has failed: a spring of its stiffness that sticks and slips. A friction
/// that only followed |s| would give energy whenever pressure and slip take turns: joints of steep
/// friction would feed themselves and all around them.
/// @param z  what the point keeps of phi; phi_r is the rest  [-]
template <class R>
BR_HD R friction_traction(const BondOf<R>& law, const R& slope, const R& pressure, const R& z,
                          const R& slip, R& stuck) {
  const R most = -pressure * (z * law.friction + (1.0 - z) * law.residual);
  const R friction = max(-most, min(most, slope * (slip - stuck)));
  stuck = slip - friction / slope;
  return friction;
}

template <class R>
struct FailedTraction {
  R normal, kept, friction;  ///< the last two along the slip  [Pa]
};
/// Torn (above). Pressed again it rubs by phi, fading to phi_r.
template <class R>
BR_HD FailedTraction<R> torn_traction(const BondOf<R>& law, const R& h, const R& opening,
                                      const R& slip, BondState<R>& state) {
  const R zero = constant<R>(0.0), one = constant<R>(1.0);
  const R slid = abs(slip), slope = law.stiffness / h;
  const R open = max(zero, opening - state.opened), slide = max(zero, slid - state.slid);
  const R per_length = law.tension / law.softening_open;  // 1/o_t
  state.damage = max(state.damage, min(one, per_length * sqrt(open * open + slide * slide)));
  state.opening = max(state.opening, opening);
  state.slip = max(state.slip, slid);
  const R z = softening(state.damage), pressure = slope * min(zero, opening);
  FailedTraction<R> t{};
  t.normal = select(opening < 0.0, pressure, z * state.normal * min(one, opening / state.opening));
  t.kept = signed_as(z * state.shear * min(one, slid / state.slip), slip);
  t.friction = friction_traction(law, slope, pressure, z, slip, state.stuck);
  return t;
}

/// Sheared (above).
template <class R>
BR_HD FailedTraction<R> sheared_traction(const BondOf<R>& law, const R& strength, const R& h,
                                         const R& opening, const R& slip, BondState<R>& state) {
  const R zero = constant<R>(0.0), one = constant<R>(1.0);
  const R slid = abs(slip), slope = law.stiffness / h, tension = law.tension * strength;
  const R o_p = 2.0 * tension / slope, pressure = slope * min(zero, opening);
  const R resists = state.shear - law.friction * pressure, yield = resists * state.slid;
  const R over_o = max(zero, opening - o_p), over_s = max(zero, slid - yield);
  state.opening = select(over_o > 0.0, max(state.opening, opening), state.opening);
  state.slip = max(state.slip, slid);
  const R x = over_o * law.tension / law.softening_open;
  const R y = over_s * resists / (law.softening_slide * strength);
  state.damage = max(state.damage, min(one, sqrt(x * x + y * y)));
  const R z = softening(state.damage), r = opening / o_p;
  const auto opened = state.opening > 0.0;
  R pull = select(r < 1.0, 2.0 * r - r * r, one);
  pull = select(opened, opening / select(opened, state.opening, one), pull);
  FailedTraction<R> t{};
  t.normal = select(opening < 0.0, pressure, z * tension * pull);
  t.kept = signed_as(z * state.shear * min(one, slid / state.slip), slip);
  t.friction = friction_traction(law, slope, pressure, z, slip, state.stuck);
  return t;
}

/// Of a point that has failed, torn or sheared; of several that have failed alike.
template <class R>
BR_HD FailedTraction<R> failed_traction(Failure how, const BondOf<R>& law, const R& strength,
                                        const R& h, const R& opening, const R& slip,
                                        BondState<R>& state) {
  return how == Failure::torn ? torn_traction(law, h, opening, slip, state)
                              : sheared_traction(law, strength, h, opening, slip, state);
}

/// The law in full, of an integration point of either criterion, or of several that have failed
/// alike. @param how  they have failed  @param strength  of this joint over its law's: scales f_t,
/// c and, so that lengths stay, both energies  [-]. @param h  initial length [m]
template <class R>
BR_HD BondTraction<R> response(Failure how, const BondOf<R>& law, const R& strength, const R& h,
                               const R& opening, const R& slip, BondState<R>& state) {
  if (how == Failure::none) return edge_response(law, strength, h, opening, slip, state);
  const FailedTraction<R> t = failed_traction(how, law, strength, h, opening, slip, state);
  return {t.normal, t.kept + t.friction};
}
BR_HD inline BondTraction<double> response(const JointBond& law, double strength, double h,
                                           double opening, double slip, BondState<double>& state) {
  return response(failure_of(state), law, strength, h, opening, slip, state);
}

/// Of the friction of a pressed point that has failed, the share of phi_r.  [-]
template <class R>
BR_HD R residual_share(const BondOf<R>& law, const BondState<R>& state) {
  const R z = softening(state.damage), rest = (1.0 - z) * law.residual;
  const R zero = constant<R>(0.0), one = constant<R>(1.0);
  return select(rest > 0.0, rest / select(rest > 0.0, z * law.friction + rest, one), zero);
}
/// Of the shear traction of a point whose state follows from its opening and slip, what residual
/// friction bears, with the sign of the slip.  [Pa]
template <class R>
BR_HD R residual_traction(Failure how, const BondOf<R>& law, const R& strength, const R& h,
                          const R& opening, const R& slip, const BondState<R>& state) {
  if (how == Failure::none) return edge_friction(law, strength, h, opening, slip, state);
  const R zero = constant<R>(0.0);
  const auto pressed = opening < 0.0;
  if (!any(pressed)) return zero;
  return select(pressed, residual_share(law, state) * (law.stiffness / h) * (slip - state.stuck),
                zero);
}
BR_HD inline double residual_traction(const JointBond& law, double strength, double h,
                                      double opening, double slip, const BondState<double>& state) {
  return residual_traction(failure_of(state), law, strength, h, opening, slip, state);
}

/// Energy that a point would give back if it were unloaded now, by direction.  [J/m2]
BR_HD inline StoredEnergy stored(const JointBond& law, double strength, double h, double opening,
                                 double slip, const BondState<double>& state) {
  if (failure_of(state) == Failure::none)
    return edge_stored(law, strength, h, opening, slip, state);
  BondState<double> same = state;
  const FailedTraction<double> t =
      failed_traction(failure_of(state), law, strength, h, opening, slip, same);
  const double spring = 0.5 * t.friction * t.friction * h / law.stiffness;
  return {0.5 * t.normal * opening, 0.5 * t.kept * slip + spring,
          spring > 0.0 ? residual_share(law, same) * spring : 0.0};
}
/// Of it, what contact of the faces can take over: that of a point that is pressed.  [J/m2]
BR_HD inline StoredEnergy stored_pressed(const JointBond& law, double strength, double h,
                                         double opening, double slip,
                                         const BondState<double>& state) {
  return opening < 0.0 ? stored(law, strength, h, opening, slip, state) : StoredEnergy{};
}

}  // namespace breccia::fdem
