#pragma once
// Two elements on rails: the tests move them, a law answers, the work of its forces is added up.

#include "dem/laws/pair_motion.hpp"

namespace breccia::dem::testing {

/// The ends of a pair, moved step by step with prescribed velocities and spins.
struct Pair {
  PairEnd<double> a{{0.0, 0.0, 0.0}, {}, {}};
  PairEnd<double> b{{0.02, 0.0, 0.0}, {}, {}};
  double excess = 0.0;  ///< R_a - R_b  [m]
  double dt = 1e-6;

  /// Moves both ends by one step of the given velocities and returns the kinematics there.
  PairMotion<double> step(const Vec3& velocity_a, const Vec3& spin_a, const Vec3& velocity_b,
                          const Vec3& spin_b) {
    a.velocity = velocity_a;
    a.spin = spin_a;
    b.velocity = velocity_b;
    b.spin = spin_b;
    a.position += dt * velocity_a;
    b.position += dt * velocity_b;
    return pair_motion<double>(a, b, excess, dt);
  }
  /// Moves b alone.
  PairMotion<double> move_b(const Vec3& velocity, const Vec3& spin = {}) {
    return step({}, {}, velocity, spin);
  }
  /// A rigid turn of the pair about an axis through the origin, by the rotation matrix of one step.
  PairMotion<double> turn(const Vec3& axis, double angle) {
    const auto turned_about = [&](const Vec3& x) {
      const double c = std::cos(angle), s = std::sin(angle);
      return c * x + s * cross(axis, x) + ((1.0 - c) * dot(axis, x)) * axis;
    };
    const Vec3 spin = (2.0 * std::tan(0.5 * angle) / dt) * axis;  // as orientations turn
    return step((1.0 / dt) * (turned_about(a.position) - a.position), spin,
                (1.0 / dt) * (turned_about(b.position) - b.position), spin);
  }
};

}  // namespace breccia::dem::testing
