#pragma once
// A piece of reinforcing bar between two elements.

#include "dem/laws/pair_motion.hpp"

namespace breccia::dem {

/// What a steel link keeps from step to step.
struct SteelState {
  double plastic_strain;  ///< eps_p, axial  [-]
  double hardening;  ///< alpha_p, accumulated plastic strain; steel_ruptured after rupture  [-]
  Vec3 shear;        ///< on b, world frame  [N]
  Vec3 moment;       ///< on b, world frame  [N m]
};
inline constexpr double steel_ruptured = -1.0;

/// What a steel link answers in one step.
struct SteelResponse {
  double normal;   ///< N, tension positive  [N]
  Vec3 shear;      ///< on b  [N]
  Vec3 moment;     ///< on b  [N m]
  double active;   ///< 1 where it resists, 0 where not  [-]
  double yielded;  ///< energy spent on yielding in this step  [J]
  double broke;    ///< energy spent by rupture in this step  [J]
};

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
  struct Stiffness {
    double axial, shear, bending, twist;  ///< [N/m], [N/m], [N m], [N m]
  };
  BR_HD Stiffness stiffness(double length, double radius) const {
    const double area = pi * radius * radius;
    const double second_moment = 0.25 * area * radius * radius;  // I = pi r^4 / 4, J = 2 I
    const double bending = young * second_moment / length;
    const double phi =
        12.0 * young * second_moment / (0.9 * shear_modulus * area * length * length);
    return {young * area / length, 12.0 * bending / (length * length * (1.0 + phi)), bending,
            2.0 * shear_modulus * second_moment / length};
  }

  BR_HD SteelResponse answer(double length, double radius, const PairMotion<double>& motion,
                             SteelState& state) const {
    const Stiffness k = stiffness(length, radius);
    const double area = pi * radius * radius;
    const double stretch = motion.distance - length;
    SteelResponse r{};

    if (state.hardening < 0.0) {  // ruptured: the ends may still be pressed together
      const bool pressed = stretch < 0.0;
      r.normal = pressed ? k.axial * stretch : 0.0;
      r.active = pressed ? 1.0 : 0.0;
      return r;
    }

    // Axial: return mapping in one dimension.
    const double strain = stretch / length;
    double stress = young * (strain - state.plastic_strain);
    const double excess = absolute(stress) - (yield + hardening * state.hardening);
    if (excess > 0.0) {
      const double increment = excess / (young + hardening);
      const double flow = stress > 0.0 ? increment : -increment;
      state.plastic_strain += flow;
      state.hardening += increment;
      stress = young * (strain - state.plastic_strain);
      r.yielded += stress * flow * area * length;
    }
    r.normal = stress * area;
    r.active = 1.0;

    // Shear, bending and twist: carried with the pair, elastic, cut at the plastic hinge.
    const Vec3 shear_before = motion.across(motion.carried(state.shear));
    Vec3 shear = shear_before - k.shear * motion.slip;
    const Vec3 moment_before = motion.carried(state.moment);
    const Vec3 twist_turn = dot(motion.turn, motion.normal) * motion.normal;
    Vec3 bending = motion.across(moment_before) - k.bending * (motion.turn - twist_turn);
    Vec3 twist = dot(moment_before, motion.normal) * motion.normal - k.twist * twist_turn;

    const double axial_share = r.normal / (yield * area);
    const double cube = 8.0 * radius * radius * radius;  // d^3
    const double reserve = 1.0 - axial_share * axial_share;
    const double bending_limit = yield * cube / 6.0 * (reserve > 0.0 ? reserve : 0.0);
    r.yielded += cut(bending, motion.across(moment_before), bending_limit, k.bending);
    r.yielded += cut(twist, moment_before - motion.across(moment_before),
                     yield / root3 * pi * cube / 12.0, k.twist);
    r.yielded += cut(shear, shear_before, yield / root3 * area, k.shear);

    if (state.hardening > failure_strain) {
      r.broke = stored(length, radius, stretch, state);
      state = {0.0, steel_ruptured, {}, {}};
      const bool pressed = stretch < 0.0;
      r.normal = pressed ? k.axial * stretch : 0.0;
      r.active = pressed ? 1.0 : 0.0;
      return r;
    }
    state.shear = shear;
    state.moment = bending + twist;
    r.shear = state.shear;
    r.moment = state.moment;
    return r;
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
