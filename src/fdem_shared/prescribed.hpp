#pragma once
// The motion that a support gives to a corner now: a velocity, and a turn about an axis.

#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia::fdem_shared {

/// How fast something turns: in the plane anticlockwise, in space about an axis.  [rad/s]
template <class Vector>
struct SpinOfVector;
template <>
struct SpinOfVector<Vec2> {
  using Spin = double;
};
template <>
struct SpinOfVector<Vec3> {
  using Spin = Vec3;
};
template <class Vector>
using SpinOf = typename SpinOfVector<Vector>::Spin;

BR_HD inline double squared(double spin) {
  return spin * spin;
}
BR_HD inline double squared(const Vec2& v) {
  return dot(v, v);
}
BR_HD inline double squared(const Vec3& spin) {
  return dot(spin, spin);
}
/// The velocity of a place by a turn, by its arm from the axis.
BR_HD inline Vec2 carried(double spin, const Vec2& arm) {
  return {-spin * arm.y, spin * arm.x};
}
BR_HD inline Vec3 carried(const Vec3& spin, const Vec3& arm) {
  return cross(spin, arm);
}

/// A motion that follows tables over time, here and now.
template <class Vector>
struct MotionNow {
  Vector velocity;        ///< over the step to come  [m/s]
  Vector centre{};        ///< a point of the axis at its beginning  [m]
  SpinOf<Vector> spin{};  ///< over the step to come  [rad/s]

  BR_HD bool turns() const { return squared(spin) > 0.0; }
  /// Velocity that takes a place where it is to be after a step of dt. The turn is Cayley's: it
  /// keeps all lengths; the angle is off by (w dt)^3/12.
  BR_HD Vector at(const Vector& place, double dt) const {
    if (!turns()) return velocity;
    const SpinOf<Vector> half = (0.5 * dt) * spin;
    const Vector across = carried(spin, place - centre);
    return velocity + (1.0 / (1.0 + squared(half))) * (across + carried(half, across));
  }
};

}  // namespace breccia::fdem_shared
