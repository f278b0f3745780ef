#pragma once
// Small value types. `R` is double in scalar code and a pack of doubles in vectorised host code.

#include <cstdint>

#include "math/pack.hpp"

namespace breccia {

/// A vector of three components.
template <class R>
struct Vec3Of {
  R x{}, y{}, z{};

  BR_HD Vec3Of& operator+=(const Vec3Of& b) {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  BR_HD Vec3Of& operator-=(const Vec3Of& b) {
    x -= b.x;
    y -= b.y;
    z -= b.z;
    return *this;
  }
};

using Vec3 = Vec3Of<double>;

template <class R>
BR_HD Vec3Of<R> operator+(const Vec3Of<R>& a, const Vec3Of<R>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class R>
BR_HD Vec3Of<R> operator-(const Vec3Of<R>& a, const Vec3Of<R>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class R>
BR_HD Vec3Of<R> operator-(const Vec3Of<R>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class R>
BR_HD Vec3Of<R> operator*(const R& s, const Vec3Of<R>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class R>
BR_HD R dot(const Vec3Of<R>& a, const Vec3Of<R>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class R>
BR_HD Vec3Of<R> cross(const Vec3Of<R>& a, const Vec3Of<R>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class R>
BR_HD R norm(const Vec3Of<R>& a) {
  return sqrt(dot(a, a));
}
template <class M, class R>
BR_HD Vec3Of<R> select(const M& condition, const Vec3Of<R>& yes, const Vec3Of<R>& no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y),
          select(condition, yes.z, no.z)};
}

/// A unit quaternion w + xi + yj + zk: the orientation of an element.
template <class R>
struct QuaternionOf {
  R w = constant<R>(1.0), x{}, y{}, z{};
};
using Quaternion = QuaternionOf<double>;

template <class R>
BR_HD QuaternionOf<R> operator*(const QuaternionOf<R>& a, const QuaternionOf<R>& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

/// The orientation after turning by the rotation vector `angle` (small): Cayley's rational form of
/// the rotation, which needs no sine; the turned angle is 2 atan(|angle| / 2). One Newton step of 1
/// / |q| keeps it a unit quaternion.
template <class R>
BR_HD QuaternionOf<R> rotated(const QuaternionOf<R>& q, const Vec3Of<R>& angle) {
  const QuaternionOf<R> t =
      QuaternionOf<R>{constant<R>(1.0), 0.5 * angle.x, 0.5 * angle.y, 0.5 * angle.z} * q;
  const R scale = 1.5 - 0.5 * (t.w * t.w + t.x * t.x + t.y * t.y + t.z * t.z);
  return {scale * t.w, scale * t.x, scale * t.y, scale * t.z};
}

}  // namespace breccia
