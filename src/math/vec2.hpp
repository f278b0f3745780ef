#pragma once
// Vectors and 2 x 2 matrices of the plane.

#include "exec/types.hpp"
#include "math/pack.hpp"

namespace breccia {

/// A vector of two components; R is double, or a pack of doubles in vectorised host code.
template <class R>
struct Vec2Of {
  R x{}, y{};

  BR_HD Vec2Of& operator+=(const Vec2Of& b) {
    x += b.x;
    y += b.y;
    return *this;
  }
  BR_HD Vec2Of& operator-=(const Vec2Of& b) {
    x -= b.x;
    y -= b.y;
    return *this;
  }
};

using Vec2 = Vec2Of<double>;

/// In another precision, rounded to the nearest.
template <class To, class From>
BR_HD Vec2Of<To> converted(const Vec2Of<From>& v) {
  return {static_cast<To>(v.x), static_cast<To>(v.y)};
}

template <class R>
BR_HD Vec2Of<R> operator+(const Vec2Of<R>& a, const Vec2Of<R>& b) {
  return {a.x + b.x, a.y + b.y};
}
template <class R>
BR_HD Vec2Of<R> operator-(const Vec2Of<R>& a, const Vec2Of<R>& b) {
  return {a.x - b.x, a.y - b.y};
}
template <class R>
BR_HD Vec2Of<R> operator-(const Vec2Of<R>& a) {
  return {-a.x, -a.y};
}
template <class R>
BR_HD Vec2Of<R> operator*(const R& s, const Vec2Of<R>& a) {
  return {s * a.x, s * a.y};
}
template <class R>
BR_HD R dot(const Vec2Of<R>& a, const Vec2Of<R>& b) {
  return a.x * b.x + a.y * b.y;
}
/// z of the cross product: twice the area of the triangle 0, a, b, positive counter-clockwise.
template <class R>
BR_HD R cross(const Vec2Of<R>& a, const Vec2Of<R>& b) {
  return a.x * b.y - a.y * b.x;
}
template <class R>
BR_HD R norm(const Vec2Of<R>& a) {
  return sqrt(dot(a, a));
}

/// A 2 x 2 matrix by rows.
template <class R>
struct Mat2Of {
  R xx{}, xy{}, yx{}, yy{};
};
using Mat2 = Mat2Of<double>;

/// Columns a and b.
template <class R>
BR_HD Mat2Of<R> columns(const Vec2Of<R>& a, const Vec2Of<R>& b) {
  return {a.x, b.x, a.y, b.y};
}
template <class R>
BR_HD R determinant(const Mat2Of<R>& m) {
  return m.xx * m.yy - m.xy * m.yx;
}
/// @param m  with a determinant other than 0
template <class R>
BR_HD Mat2Of<R> inverse(const Mat2Of<R>& m) {
  const R scale = 1.0 / determinant(m);
  return {scale * m.yy, -scale * m.xy, -scale * m.yx, scale * m.xx};
}
template <class R>
BR_HD Mat2Of<R> operator*(const Mat2Of<R>& a, const Mat2Of<R>& b) {
  return {a.xx * b.xx + a.xy * b.yx, a.xx * b.xy + a.xy * b.yy, a.yx * b.xx + a.yy * b.yx,
          a.yx * b.xy + a.yy * b.yy};
}
template <class R>
BR_HD Vec2Of<R> operator*(const Mat2Of<R>& m, const Vec2Of<R>& v) {
  return {m.xx * v.x + m.xy * v.y, m.yx * v.x + m.yy * v.y};
}

/// A symmetric 2 x 2 tensor: stress, strain.
template <class R>
struct Sym2Of {
  R xx{}, yy{}, xy{};
};
using Sym2 = Sym2Of<double>;

template <class R>
BR_HD Vec2Of<R> operator*(const Sym2Of<R>& s, const Vec2Of<R>& v) {
  return {s.xx * v.x + s.xy * v.y, s.xy * v.x + s.yy * v.y};
}
/// Double contraction a : b.
template <class R>
BR_HD R contract(const Sym2Of<R>& a, const Sym2Of<R>& b) {
  return a.xx * b.xx + a.yy * b.yy + 2.0 * (a.xy * b.xy);
}

}  // namespace breccia
