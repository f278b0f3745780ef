#pragma once
// 3 x 3 matrices and symmetric tensors.

#include "math/vec.hpp"

namespace breccia {

/// A matrix by its columns.
template <class R>
struct Mat3Of {
  Vec3Of<R> a{}, b{}, c{};
};
using Mat3 = Mat3Of<double>;

template <class R>
BR_HD Vec3Of<R> operator*(const Mat3Of<R>& m, const Vec3Of<R>& v) {
  return v.x * m.a + v.y * m.b + v.z * m.c;
}
template <class R>
BR_HD R determinant(const Mat3Of<R>& m) {
  return dot(m.a, cross(m.b, m.c));
}
/// The matrix of cofactors: det(m) times the inverse, transposed.
template <class R>
BR_HD Mat3Of<R> cofactors(const Mat3Of<R>& m) {
  return {cross(m.b, m.c), cross(m.c, m.a), cross(m.a, m.b)};
}

/// A symmetric tensor: stress, strain.
template <class R>
struct Sym3Of {
  R xx{}, yy{}, zz{}, yz{}, xz{}, xy{};
};
using Sym3 = Sym3Of<double>;

template <class R>
BR_HD Vec3Of<R> operator*(const Sym3Of<R>& s, const Vec3Of<R>& v) {
  return {s.xx * v.x + s.xy * v.y + s.xz * v.z, s.xy * v.x + s.yy * v.y + s.yz * v.z,
          s.xz * v.x + s.yz * v.y + s.zz * v.z};
}
/// Double contraction a : b.
template <class R>
BR_HD R contract(const Sym3Of<R>& a, const Sym3Of<R>& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2.0 * (a.yz * b.yz + a.xz * b.xz + a.xy * b.xy);
}
template <class R>
BR_HD R trace(const Sym3Of<R>& s) {
  return s.xx + s.yy + s.zz;
}
/// Component (i, j), each 0 to 2.
template <class R>
BR_HD R component(const Sym3Of<R>& s, int i, int j) {
  if (i == j) return i == 0 ? s.xx : i == 1 ? s.yy : s.zz;
  const int sum = i + j;
  return sum == 1 ? s.xy : sum == 2 ? s.xz : s.yz;
}

}  // namespace breccia
