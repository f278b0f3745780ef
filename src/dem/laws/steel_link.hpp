#pragma once
// A piece of reinforcing bar between two elements.

#include "dem/laws/pair_motion.hpp"

namespace breccia::dem {

/// State of a steel link, kept from step to step.
template <class R>
struct SteelStateOf {
  R plastic_strain;  ///< eps_p, axial  [-]
  R hardening;       ///< alpha_p, accumulated plastic strain; steel_ruptured after rupture  [-]
  Vec3Of<R> shear;   ///< on b, world frame  [N]
  Vec3Of<R> moment;  ///< on b, world frame  [N m]
};
using SteelState = SteelStateOf<double>;
inline constexpr double steel_ruptured = -1.0;

/// Response of a steel link in one step.
template <class R>
struct SteelResponseOf {
  R normal;          ///< N, tension positive  [N]
  Vec3Of<R> shear;   ///< on b  [N]
  Vec3Of<R> moment;  ///< on b  [N m]
  R active;          ///< 1 where it resists, 0 where not  [-]
  R yielded;         ///< energy spent on yielding in this step  [J]
  R broke;           ///< energy spent by rupture in this step  [J]
};
using SteelResponse = SteelResponseOf<double>;

/// Two-node Timoshenko beam of circular section in the variables of a pair, its contact point in
/// the middle: exact for bending and shear, so a chain converges to beam theory (docs/theory.md,
/// steel).
///
///   K_n = E A / L,  K_t = 12 E I / (L^3 (1 + Phi)),  K_b = E I / L,  K_w = G J / L
///   axial: sigma = E (eps - eps_p), |sigma| <= f_y + H alpha_p (linear isotropic hardening)
///   hinge: |M_b| <= f_y d^3 / 6 (1 - (N/N_p)^2), |M_w| <= f_y / sqrt3 pi d^3 / 12, |F_s| <= A f_y
///   / sqrt3 rupture when alpha_p exceeds the failure strain; then it only bears compression
struct SteelLink {
  double young;           ///< E  [Pa]
  double shear_modulus;   ///< G  [Pa]
  double yield;           ///< f_y  [Pa]
  double hardening;       ///< H  [Pa]
  double failure_strain;  ///< eps_u  [-]

  static constexpr double pi = 3.14159265358979323846;
  static constexpr double root3 = 1.7320508075688772;

  /// Elastic stiffnesses of a piece of bar of length L and radius r.
  template <class R>
  struct StiffnessOf {
    R axial, shear, bending, twist;  ///< [N/m], [N/m], [N m], [N m]
  };
  using Stiffness = StiffnessOf<double>;
  template <class R>
  BR_HD StiffnessOf<R> stiffness(const R& length, const R& radius) const {
    const R area = pi * radius * radius;
    const R second_moment = 0.25 * area * radius * radius;  // I = pi r^4 / 4, J = 2 I
    const R bending = young * second_moment / length;
    const R phi = 12.0 * young * second_moment / (0.9 * shear_modulus * area * length * length);
    return {young * area / length, 12.0 * bending / (length * length * (1.0 + phi)), bending,
            2.0 * shear_modulus * second_moment / length};
  }

  BR_HD SteelResponse response(double length, double radius, const PairMotion<double>& motion,
                               SteelState& state) const {
    const Stiffness k = stiffness(length, radius);
    const double stretch = motion.distance - length;
    SteelResponse r{};

    if (state.hardening < 0.0) {  // ruptured: the ends may still be pressed together
      press(k, stretch, r);
      return r;
    }
    Trial<double> t = trial(k, length, radius, motion, state);

    // Axial: return mapping in one dimension.
    if (t.excess > 0.0) {
      const double increment = t.excess / (young + hardening);
      const double flow = t.stress > 0.0 ? increment : -increment;
      state.plastic_strain += flow;
      state.hardening += increment;
      t.stress = young * (stretch / length - state.plastic_strain);
      r.yielded += t.stress * flow * t.area * length;
    }
    r.normal = t.stress * t.area;
    r.active = 1.0;

    // The plastic hinge.
    const Limits<double> limits = hinge(radius, t.area, r.normal);
    r.yielded += cut(t.bending, motion.tangential(t.moment_before), limits.bending, k.bending);
    r.yielded +=
        cut(t.twist, t.moment_before - motion.tangential(t.moment_before), limits.twist, k.twist);
    r.yielded += cut(t.shear, t.shear_before, limits.shear, k.shear);

    if (state.hardening > failure_strain) {
      r.broke = stored(length, radius, stretch, state);
      state = {0.0, steel_ruptured, {}, {}};
      press(k, stretch, r);
      return r;
    }
    keep(t, state, r);
    return r;
  }

  /// Response of a pack of links of which none is ruptured, yields or breaks.
  /// @returns false, having done nothing, if one is or does
  template <class R>
  BR_HD bool elastic_response(const StiffnessOf<R>& k, const R& length, const R& radius,
                              const PairMotion<R>& motion, SteelStateOf<R>& state,
                              SteelResponseOf<R>& r) const {
    const Trial<R> t = trial(k, length, radius, motion, state);
    r.normal = t.stress * t.area;
    r.active = constant<R>(1.0);
    r.yielded = r.broke = constant<R>(0.0);
    const Limits<R> limits = hinge(radius, t.area, r.normal);
    const auto elastic = state.hardening >= 0.0 && !(t.excess > 0.0) &&
                         norm(t.bending) <= limits.bending && norm(t.twist) <= limits.twist &&
                         norm(t.shear) <= limits.shear;
    if (any(!elastic || state.hardening > failure_strain)) return false;
    keep(t, state, r);
    return true;
  }

  /// Energy a link stores.  [J]
  BR_HD double stored(double length, double radius, double stretch, const SteelState& state) const {
    const Stiffness k = stiffness(length, radius);
    if (state.hardening < 0.0) return stretch < 0.0 ? 0.5 * k.axial * stretch * stretch : 0.0;
    const double elastic = stretch - length * state.plastic_strain;
    return 0.5 * k.axial * elastic * elastic + dot(state.shear, state.shear) / (2.0 * k.shear);
  }
  /// Energy of the moments, which need the bar's direction to be told apart.  [J]
  BR_HD double stored_moment(double length, double radius, const Vec3& normal,
                             const SteelState& state) const {
    const Stiffness k = stiffness(length, radius);
    const double twist = dot(state.moment, normal);
    return (dot(state.moment, state.moment) - twist * twist) / (2.0 * k.bending) +
           twist * twist / (2.0 * k.twist);
  }

 private:
  /// Response to a step of elastic motion.
  template <class R>
  struct Trial {
    R area;                                 ///< of the section  [m2]
    R stress, excess;                       ///< axial, and above the yield stress  [Pa]
    Vec3Of<R> shear_before, moment_before;  ///< carried with the pair  [N], [N m]
    Vec3Of<R> shear, bending, twist;        ///< and with this step's increment
  };
  template <class R>
  BR_HD Trial<R> trial(const StiffnessOf<R>& k, const R& length, const R& radius,
                       const PairMotion<R>& motion, const SteelStateOf<R>& state) const {
    Trial<R> t;
    t.area = pi * radius * radius;
    const R strain = (motion.distance - length) / length;
    t.stress = young * (strain - state.plastic_strain);
    t.excess = abs(t.stress) - (yield + hardening * state.hardening);

    t.shear_before = motion.tangential(motion.rotated_with_pair(state.shear));
    t.shear = t.shear_before - k.shear * motion.slip;
    t.moment_before = motion.rotated_with_pair(state.moment);
    const Vec3Of<R> twist_turn = dot(motion.turn, motion.normal) * motion.normal;
    t.bending = motion.tangential(t.moment_before) - k.bending * (motion.turn - twist_turn);
    t.twist = dot(t.moment_before, motion.normal) * motion.normal - k.twist * twist_turn;
    return t;
  }
  /// Largest moment of the plastic hinge.
  template <class R>
  struct Limits {
    R bending, twist, shear;  ///< [N m], [N m], [N]
  };
  template <class R>
  BR_HD Limits<R> hinge(const R& radius, const R& area, const R& normal) const {
    const R axial_share = normal / (yield * area);
    const R cube = 8.0 * radius * radius * radius;  // d^3
    const R reserve = 1.0 - axial_share * axial_share;
    const R zero = constant<R>(0.0);
    return {yield * cube / 6.0 * select(reserve > 0.0, reserve, zero),
            yield / root3 * pi * cube / 12.0, yield / root3 * area};
  }
  template <class R>
  BR_HD static void keep(const Trial<R>& t, SteelStateOf<R>& state, SteelResponseOf<R>& r) {
    state.shear = t.shear;
    state.moment = t.bending + t.twist;
    r.shear = state.shear;
    r.moment = state.moment;
  }
  /// Response of a ruptured link.
  BR_HD static void press(const Stiffness& k, double stretch, SteelResponse& r) {
    const bool pressed = stretch < 0.0;
    r.normal = pressed ? k.axial * stretch : 0.0;
    r.active = pressed ? 1.0 : 0.0;
  }
  /// Shortens a force or moment to its limit; returns the energy that took.
  BR_HD static double cut(Vec3& value, const Vec3& before, double limit, double stiffness) {
    const double size = norm(value);
    if (size <= limit) return 0.0;
    const Vec3 trial = value;
    value = (limit / size) * trial;
    return 0.5 / stiffness * dot(before + value, trial - value);
  }
};

}  // namespace breccia::dem
