#pragma once
// Rigid bodies with mass: what a support holds as a whole and its `free` lets go where the forces
// on it lead. Written in fdem_shared/rigid_bodies.hpp.
//
// A body keeps the velocity V of its centre of mass and its angular momentum L about that, half a
// step before the positions, and takes the half steps of the corners (motion.hpp):
//
//   V_+ = V_- + (F/M + g) dt,   L_+ = L_- + T dt,   w = J^-1 L_+ at half of the turn
//
// with the sums F and T of all forces on its corners and of those that the case gives, exact sums
// of any order. M and J are those of the masses at its corners, so it is the very body that its
// elements would be if their moduli were infinite, and no stiffness of its own bounds the step.
// Tests: tests/physics/rigid_bodies_test.cpp.

#include <cstddef>
#include <cstdint>

#include "fdem_shared/over_time.hpp"
#include "math/mat3.hpp"

namespace breccia::fdem_shared {

/// A vector turned by an angle: Cayley's rotation, which keeps its length.
inline Vec3 turned(const Vec3& v, const Vec3& angle) {
  const Vec3 half = 0.5 * angle, aside = cross(half, v);
  return v + (2.0 / (1.0 + dot(half, half))) * (aside + cross(half, aside));
}

/// How a body lies and what turns it.
template <class Vector>
struct TurnOf;
template <>
struct TurnOf<Vec2> {
  double inertia = 0.0;  ///< about its centre of mass  [kg m]

  double spin(double angular, double) const { return angular / inertia; }
  double momentum(double spin) const { return inertia * spin; }
  void go(double) {}
};
template <>
struct TurnOf<Vec3> {
  Sym3 inverse{};  ///< of its inertia about the centre of mass, in its frame  [1/(kg m2)]
  Vec3 x{1.0, 0.0, 0.0}, y{0.0, 1.0, 0.0};  ///< axes of its frame now

  /// The angular momentum of a spin.
  Vec3 momentum(const Vec3& spin) const {
    const Sym3& j = inverse;
    const Mat3 all{{j.xx, j.xy, j.xz}, {j.xy, j.yy, j.yz}, {j.xz, j.yz, j.zz}};
    const Mat3 over = cofactors(all);
    const Vec3 z = cross(x, y);
    const Vec3 in =
        (1.0 / determinant(all)) * (over * Vec3{dot(spin, x), dot(spin, y), dot(spin, z)});
    return in.x * x + in.y * y + in.z * z;
  }
  /// Its spin where it lies.
  Vec3 spin(const Vec3& angular) const {
    const Vec3 z = cross(x, y);
    const Vec3 in = inverse * Vec3{dot(angular, x), dot(angular, y), dot(angular, z)};
    return in.x * x + in.y * y + in.z * z;
  }
  /// Its spin at half of the turn that it makes in a step of dt.
  Vec3 spin(const Vec3& angular, double dt) const {
    constexpr int passes = 4;
    Vec3 found = spin(angular);
    for (int pass = 0; pass < passes; ++pass) {
      TurnOf half = *this;
      half.go((0.5 * dt) * found);
      found = half.spin(angular);
    }
    return found;
  }
  void go(const Vec3& angle) {
    x = turned(x, angle);
    x = (1.0 / norm(x)) * x;
    y = turned(y, angle);
    y = y - dot(y, x) * x;
    y = (1.0 / norm(y)) * y;
  }
};

/// State of a body; that of a support that is not free has no mass.
template <class Vector>
struct RigidStateOf {
  double mass = 0.0;         ///<  [kg; in 2D kg/m]
  Vector centre{};           ///< of its mass  [m]
  Vector velocity{};         ///< of that, half a step before the positions  [m/s]
  SpinOf<Vector> angular{};  ///< momentum about it, likewise  [kg m2/s; in 2D kg m/s]
  TurnOf<Vector> turn;

  bool is_there() const { return mass > 0.0; }
};

/// A body that moves by the forces on it in this stage.
template <class Vector>
struct RigidBodyOf {
  std::size_t support;
  std::size_t set;      ///< of its corners, in Case::sets
  std::int16_t motion;  ///< in World::prescribed: how it moves in directions that are not free
  int along;            ///< bits of the free directions: x, y, z
  bool turns;
  Vector force{};  ///< given, at the centre of mass  [N; in 2D N/m]
  AmplitudeOf<Vector> force_over{};
  SpinOf<Vector> torque{};  ///< given  [N m; in 2D N]
  AmplitudeOf<SpinOf<Vector>> torque_over{};

  Vector force_at(double time) const { return by_parts(force_over.at(time), force); }
  SpinOf<Vector> torque_at(double time) const { return by_parts(torque_over.at(time), torque); }
};

}  // namespace breccia::fdem_shared
