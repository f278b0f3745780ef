#pragma once
// Contact law of two elements, or an element and a wall, that no link joins.

#include "dem/laws/pair_motion.hpp"

namespace breccia::dem {

/// State of a contact, kept while it lasts.
struct ContactState {
  Vec3 shear;      ///< F_s on b, world frame  [N]
  Vec3 moment;     ///< M on b, world frame  [N m]
  double stored;   ///< energy of shear and moment  [J]
  double dashpot;  ///< normal force of the dashpot, compression positive  [N]
  double overlap;  ///< delta, of the last step  [m]
};

/// Response of a contact in one step.
struct ContactResponse {
  double pressure;  ///< normal force, compression positive  [N]
  Vec3 shear;       ///< on b  [N]
  Vec3 moment;      ///< on b  [N m]
  double normal_stiffness, shear_stiffness, rolling_stiffness;  ///< tangents; 0 when apart
  double slid;    ///< energy spent on sliding and rolling in this step  [J]
  double damped;  ///< energy taken by the dashpot in this step  [J]
};

/// Constants of a pair of materials in contact.
struct ContactPair {
  double normal;  ///< linear: K_n over min(R)^2 / (R_a + R_b)  [Pa]; Hertz: E*  [Pa]
  double shear;   ///< linear: K_t / K_n  [-]; Hertz: G*  [Pa]
};

/// Linear springs or Hertz and Mindlin, Coulomb friction, a dashpot, a rolling limit
/// (docs/theory.md, contacts).
///
///   linear   N = K_n delta, K_t = ratio K_n;  dashpot c = 2 xi sqrt(m* K_n)
///   Hertz    N = 4/3 E* sqrt(R*) delta^1.5, K_t = 8 G* sqrt(R* delta);
///            dashpot c = 2 xi sqrt(m* S_n), S_n = 2 E* sqrt(R* delta)
///   no attraction: N + dashpot >= 0. xi is chosen at set-up so that the restitution is what the
///   case asks. shear    incremental, |F_s| <= mu N;  moment incremental, |M| <= eta r N
struct ContactLaw {
  bool hertz;            ///< Hertz and Mindlin, otherwise linear
  double friction;       ///< mu  [-]
  double damping;        ///< xi  [-]
  double rolling_ratio;  ///< beta_r = K_r / (K_t r^2)  [-]
  double rolling_limit;  ///< eta  [-]

  /// Size and mass of the pair; a wall has no curvature and no limit of mass.
  struct Pair {
    double radius;   ///< R*  [m]
    double smaller;  ///< the smaller radius, pi times whose square is the section  [m]
    double sum;      ///< R_a + R_b, or 2 R at a wall  [m]
    double mass;     ///< m*  [kg]
    double arm;      ///< r, mean radius, of the rolling moment  [m]
  };

  BR_HD ContactResponse response(const ContactPair& material, const Pair& pair, double overlap,
                                 double approach, const PairMotion<double>& motion,
                                 ContactState& state) const {
    ContactResponse r{};
    // Forces of a step work on half of the way before it and half of the way after it, also where a
    // part of that way is a gap.
    const Vec3 shear_before = motion.tangential(motion.rotated_with_pair(state.shear));
    const Vec3 moment_before = motion.rotated_with_pair(state.moment);
    if (overlap <= 0.0) {
      r.slid = state.stored - 0.5 * dot(shear_before, motion.slip) -
               0.5 * dot(moment_before, motion.turn);
      r.damped = -0.5 * state.dashpot * motion.extension;
      if (damping > 0.0 && state.overlap > 0.0)
        r.damped += stored_normal(material, pair, state.overlap) -
                    0.5 * spring(material, pair, state.overlap) * motion.extension;
      state = {};
      return r;
    }
    double elastic = 0.0, shear_stiffness = 0.0;
    if (hertz) {
      const double chord = sqrt(pair.radius * overlap);
      r.normal_stiffness = 2.0 * material.normal * chord;
      elastic = r.normal_stiffness * overlap * (2.0 / 3.0);
      shear_stiffness = 8.0 * material.shear * chord;
    } else {
      r.normal_stiffness = material.normal * pair.smaller * pair.smaller / pair.sum;
      elastic = r.normal_stiffness * overlap;
      shear_stiffness = material.shear * r.normal_stiffness;
    }
    const double rolling_stiffness = rolling_ratio * shear_stiffness * pair.arm * pair.arm;

    // Normal: spring and dashpot, never attraction.
    double dashpot = 0.0;
    if (damping > 0.0)
      dashpot = max(2.0 * damping * sqrt(pair.mass * r.normal_stiffness) * approach, -elastic);
    r.pressure = elastic + dashpot;
    r.damped = 0.5 * (state.dashpot + dashpot) *
               (state.overlap > 0.0 ? overlap - state.overlap : -motion.extension);
    // The spring takes more on the way from a gap than it stores, and so a collision loses more
    // than its dashpot takes; as it ends, less.
    if (damping > 0.0 && state.overlap <= 0.0)
      r.damped -= 0.5 * elastic * motion.extension + stored_normal(material, pair, overlap);

    // Shear and rolling.
    r.shear = shear_before - shear_stiffness * motion.slip;
    r.moment = moment_before - rolling_stiffness * motion.turn;
    cut(r.shear, friction * r.pressure);
    cut(r.moment, rolling_limit * pair.arm * r.pressure);
    double stored = 0.0;
    if (shear_stiffness > 0.0) stored += dot(r.shear, r.shear) / (2.0 * shear_stiffness);
    if (rolling_stiffness > 0.0) stored += dot(r.moment, r.moment) / (2.0 * rolling_stiffness);
    const double work = -0.5 * dot(shear_before + r.shear, motion.slip) -
                        0.5 * dot(moment_before + r.moment, motion.turn);
    r.slid = work - (stored - state.stored);

    r.shear_stiffness = shear_stiffness;
    r.rolling_stiffness = rolling_stiffness;
    if (damping > 0.0) r.normal_stiffness /= shrink() * shrink();
    state = {r.shear, r.moment, stored, dashpot, overlap};
    return r;
  }

  /// Energy of the normal spring.  [J]
  BR_HD double stored_normal(const ContactPair& material, const Pair& pair, double overlap) const {
    if (overlap <= 0.0) return 0.0;
    if (hertz)
      return 8.0 / 15.0 * material.normal * sqrt(pair.radius * overlap) * overlap * overlap;
    return 0.5 * material.normal * pair.smaller * pair.smaller / pair.sum * overlap * overlap;
  }

  /// The factor by which the dashpot shortens the stable step:
  /// dt <= 2/omega (sqrt(1 + xi^2) - xi).  [-]
  BR_HD double shrink() const { return sqrt(1.0 + damping * damping) - damping; }

 private:
  /// Force of the normal spring.  [N]
  BR_HD double spring(const ContactPair& material, const Pair& pair, double overlap) const {
    if (hertz) return 4.0 / 3.0 * material.normal * sqrt(pair.radius * overlap) * overlap;
    return material.normal * pair.smaller * pair.smaller / pair.sum * overlap;
  }
  BR_HD static void cut(Vec3& value, double limit) {
    const double size = norm(value);
    if (size > limit) value = (limit / size) * value;
  }
};

}  // namespace breccia::dem
