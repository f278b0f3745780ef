#pragma once
// Principal values of symmetric tensors.

#include <algorithm>
#include <array>
#include <cmath>

#include "math/mat3.hpp"

namespace breccia {

/// The three principal values, the largest first, by Jacobi's rotations (1846): squares and roots
/// alone, so that every machine finds the same bits.
inline std::array<double, 3> principal_values(const Sym3& s) {
  constexpr int sweeps = 8;  // each squares what is left beside the diagonal
  std::array<std::array<double, 3>, 3> a{
      {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}};
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const auto& [p, q, r] : {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 1}, {1, 2, 0}}) {
      if (a[p][q] == 0.0) continue;
      const double half = 0.5 * (a[q][q] - a[p][p]);
      const double root = std::fabs(half) + std::sqrt(half * half + a[p][q] * a[p][q]);
      const double tangent = half < 0.0 ? -a[p][q] / root : a[p][q] / root;
      const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent), sine = tangent * cosine;
      a[p][p] -= tangent * a[p][q];
      a[q][q] += tangent * a[p][q];
      a[p][q] = a[q][p] = 0.0;
      const double before_p = a[p][r], before_q = a[q][r];
      a[p][r] = a[r][p] = cosine * before_p - sine * before_q;
      a[q][r] = a[r][q] = sine * before_p + cosine * before_q;
    }
  std::array<double, 3> values{a[0][0], a[1][1], a[2][2]};
  std::sort(values.begin(), values.end(), [](double x, double y) { return x > y; });
  return values;
}

/// Von Mises's equivalent of a stress: that of uniaxial tension with the same energy of shape.
inline double von_mises(const Sym3& s) {
  const double x = s.xx - s.yy, y = s.yy - s.zz, z = s.zz - s.xx;
  return std::sqrt(0.5 * (x * x + y * y + z * z) + 3.0 * (s.xy * s.xy + s.yz * s.yz + s.xz * s.xz));
}

}  // namespace breccia
