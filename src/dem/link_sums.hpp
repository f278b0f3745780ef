#pragma once
// Sums of links at an element, and its totals: one element or a pack of neighbours at a
// time.

#include "math/lanes.hpp"

namespace breccia::dem {

/// Stiffnesses of pairs (PairForce::stiffness) added up at one end.
struct StiffnessSums {
  EightFloatSums straight;  ///< of all eight: `turn` of this end among them, and K
  EightFloatSums turning;   ///< of ratio K, likewise from 1 to 6

  BR_HD void add(const float* stiffness) {
    straight.add(stiffness);
    turning.add(stiffness[8], stiffness);
  }
};

/// Running sums of an element's concrete links. Zero between two steps.
struct LinkSums {
  SixSums as_b;  ///< force, then torque, of links that end at the element  [N, N m]
  StiffnessSums stiffness_b;
  SixSums as_a;  ///< torque, then minus the force, of links that start there
  StiffnessSums stiffness_a;

  /// Member by member: the whole at once becomes a slow loop.
  BR_HD void clear_stiffness() {
    stiffness_b.straight = stiffness_b.turning = {};
    stiffness_a.straight = stiffness_a.turning = {};
  }
  /// Adds what a pair does to its end b, as PairForce has it.
  template <class Number>
  BR_HD void add_as_b(const Number* numbers, const float* stiffness) {
    as_b.add(numbers + 3);
    stiffness_b.add(stiffness);
  }
};
static_assert(sizeof(LinkSums) == 224);

/// Totals of an element from all its sums.
template <class R>
struct TotalsOf {
  Vec3Of<R> force, torque;  ///<  [N], [N m]
};

/// A symmetric matrix by its components xx yy zz xy xz yz.
/// @tparam F  float, or several of neighbouring elements
template <class F>
struct Symmetric {
  F c[6];

  /// A third of the trace: the mean of the eigenvalues.
  BR_HD F mean() const { return (c[0] + c[1] + c[2]) * (1.0F / 3.0F); }
  /// Two thirds of the squared norm of the deviator: no eigenvalue is further from the mean than
  /// its root, and one is as far where the other two are alike. It does not depend on the axes.
  BR_HD F square_spread() const {
    const F p = c[0] - c[1], q = c[1] - c[2], r = c[2] - c[0];
    return (p * p + q * q + r * r) * (2.0F / 9.0F) +
           (c[3] * c[3] + c[4] * c[4] + c[5] * c[5]) * (4.0F / 3.0F);
  }
};

/// Bounds of the largest stiffness of an element.
struct Stiffest {
  float straight, turning;  ///<  [N/m], [N m]
};
/// @param turn  sum of the pairs' `turn`
BR_HD inline Stiffest stiffest(const Symmetric<float>& straight, const Symmetric<float>& turning,
                               float turn) {
  return {straight.mean() + sqrtf(straight.square_spread()),
          (turn - turning.mean()) + sqrtf(turning.square_spread())};
}

/// All coordinates of a kind are held (bits of Fixed from `first` on): nothing can move.
BR_HD inline bool is_held(int fixed, int first) {
  return (fixed >> first & 7) == 7;
}

/// Bounds of the largest stiffness of a free motion of element e.
/// @param fixed  coordinates that are not free, bits of Fixed. Those of a kind count as free unless
///               all three are held: the bound then does not depend on the axes.
/// @param straight, turning  get them  [N/m], [N m]
BR_HD inline void find_stiffest(const View<LinkSums>& sums, const View<const std::uint8_t>& fixed,
                                Index e, double& straight, double& turning) {
  const LinkSums& s = sums[e];
  Symmetric<float> k, theta;
  for (int c = 0; c < 6; ++c) {
    k.c[c] = s.stiffness_a.straight[1 + c] + s.stiffness_b.straight[1 + c];
    theta.c[c] = s.stiffness_a.turning[1 + c] + s.stiffness_b.turning[1 + c];
  }
  const Stiffest most = stiffest(k, theta, s.stiffness_a.straight[0] + s.stiffness_b.straight[7]);
  straight = is_held(fixed[e], 0) ? 0.0 : static_cast<double>(most.straight);
  turning = is_held(fixed[e], 3) ? 0.0 : static_cast<double>(most.turning);
}

/// Vectors first, first + 1, ... of an array, written.
BR_HD inline void store_vectors(const View<Vec3>& vectors, Index first, const Vec3& v) {
  vectors[first] = v;
}

template <class R>
BR_HD TotalsOf<R> totals(const View<LinkSums>& sums, Index e) {
  const LinkSums& s = sums[e];
  return {{s.as_b[0] - s.as_a[3], s.as_b[1] - s.as_a[4], s.as_b[2] - s.as_a[5]},
          {s.as_b[3] + s.as_a[0], s.as_b[4] + s.as_a[1], s.as_b[5] + s.as_a[2]}};
}

#if !defined(__CUDACC__) && defined(__AVX2__)

using EightFloats = float __attribute__((vector_size(32)));

/// The bounds of four neighbours. @param straight, turning  room for four each
inline void stiffest_of_four(const LinkSums* sums, double* straight, double* turning) {
  const auto lower = [](EightFloats x) { return _mm256_castps256_ps128(x); };
  const auto upper = [](EightFloats x) { return _mm256_extractf128_ps(x, 1); };
  // Of each matrix: numbers k and 4 + k of all four.
  const auto columns = [](__m256 e0, __m256 e1, __m256 e2, __m256 e3, __m256(&of)[4]) {
    const __m256 low01 = _mm256_unpacklo_ps(e0, e1), low23 = _mm256_unpacklo_ps(e2, e3);
    const __m256 high01 = _mm256_unpackhi_ps(e0, e1), high23 = _mm256_unpackhi_ps(e2, e3);
    of[0] = _mm256_shuffle_ps(low01, low23, 0x44);
    of[1] = _mm256_shuffle_ps(low01, low23, 0xee);
    of[2] = _mm256_shuffle_ps(high01, high23, 0x44);
    of[3] = _mm256_shuffle_ps(high01, high23, 0xee);
  };
  const auto sum = [sums](int k, EightFloatSums StiffnessSums::*of) {
    return __m256((sums[k].stiffness_a.*of).sum + (sums[k].stiffness_b.*of).sum);
  };
  __m256 s[4], t[4];
  constexpr auto of_k = &StiffnessSums::straight, of_theta = &StiffnessSums::turning;
  columns(sum(0, of_k), sum(1, of_k), sum(2, of_k), sum(3, of_k), s);
  columns(sum(0, of_theta), sum(1, of_theta), sum(2, of_theta), sum(3, of_theta), t);
  // Both matrices side by side: numbers 1 to 3, then 4 to 6.
  Symmetric<EightFloats> both;
  for (int k = 0; k < 3; ++k) {
    both.c[k] = EightFloats(_mm256_permute2f128_ps(s[k + 1], t[k + 1], 0x20));
    both.c[3 + k] = EightFloats(_mm256_permute2f128_ps(s[k], t[k], 0x31));
  }
  const EightFloats mean = both.mean();
  const EightFloats spread = EightFloats(_mm256_sqrt_ps(both.square_spread()));
  alignas(16) float turn[4];
  for (int k = 0; k < 4; ++k)
    turn[k] = sums[k].stiffness_a.straight[0] + sums[k].stiffness_b.straight[7];
  _mm256_storeu_pd(straight, _mm256_cvtps_pd(lower(mean + spread)));
  const __m128 rest = _mm_sub_ps(_mm_load_ps(turn), upper(mean));
  _mm256_storeu_pd(turning, _mm256_cvtps_pd(_mm_add_ps(rest, upper(spread))));
}

/// Of element e and its neighbours in a pack.
template <class R>
requires(width_of<R> > 1) inline void find_stiffest(const View<LinkSums>& sums,
                                                    const View<const std::uint8_t>& fixed, Index e,
                                                    R& straight, R& turning) {
  double numbers[2][width_of<R>];
  std::uint8_t held[width_of<R>], none[width_of<R>] = {};
  for (Index first = 0; first < width_of<R>; first += 4)
    stiffest_of_four(sums.data + e + first, numbers[0] + first, numbers[1] + first);
  __builtin_memcpy(held, fixed.data + e, sizeof held);
  if (__builtin_memcmp(held, none, sizeof held) != 0)
    for (Index k = 0; k < width_of<R>; ++k) {
      if (is_held(held[k], 0)) numbers[0][k] = 0.0;
      if (is_held(held[k], 3)) numbers[1][k] = 0.0;
    }
  straight = pack_of<R>(numbers[0]);
  turning = pack_of<R>(numbers[1]);
}

#endif

#if !defined(__CUDACC__) && defined(__AVX512F__)

inline void store_vectors(const View<Vec3>& vectors, Index first, const Vec3Of<Pack8>& v) {
  const auto mixed = [&](__m512i of_xy, __m512i with_z) {
    return _mm512_permutex2var_pd(_mm512_permutex2var_pd(v.x, of_xy, v.y), with_z, v.z);
  };
  auto* const to = reinterpret_cast<double*>(vectors.data + first);
  _mm512_storeu_pd(to, mixed(_mm512_setr_epi64(0, 8, 0, 1, 9, 0, 2, 10),
                             _mm512_setr_epi64(0, 1, 8, 3, 4, 9, 6, 7)));
  _mm512_storeu_pd(to + 8, mixed(_mm512_setr_epi64(0, 3, 11, 0, 4, 12, 0, 5),
                                 _mm512_setr_epi64(10, 1, 2, 11, 4, 5, 12, 7)));
  _mm512_storeu_pd(to + 16, mixed(_mm512_setr_epi64(13, 0, 6, 14, 0, 7, 15, 0),
                                  _mm512_setr_epi64(0, 13, 2, 3, 14, 5, 6, 15)));
}

template <>
inline TotalsOf<Pack8> totals<Pack8>(const View<LinkSums>& sums, Index e) {
  Pack8 c[20];  // stiffnesses in between
  gather_records(View<const LinkSums>(sums), consecutive<Pack8>(e), c);
  const Pack8* const b = c;
  const Pack8* const a = c + 14;
  return {{b[0] - a[3], b[1] - a[4], b[2] - a[5]}, {b[3] + a[0], b[4] + a[1], b[5] + a[2]}};
}

#elif !defined(__CUDACC__) && defined(__AVX2__)

inline void store_vectors(const View<Vec3>& vectors, Index first, const Vec3Of<Pack4>& v) {
  for (Index k = 0; k < 4; ++k) vectors[first + k] = {v.x[k], v.y[k], v.z[k]};
}

template <>
inline TotalsOf<Pack4> totals<Pack4>(const View<LinkSums>& sums, Index e) {
  Pack4 c[20];  // stiffnesses in between
  gather_records(View<const LinkSums>(sums), consecutive<Pack4>(e), c);
  const Pack4* const b = c;
  const Pack4* const a = c + 14;
  return {{b[0] - a[3], b[1] - a[4], b[2] - a[5]}, {b[3] + a[0], b[4] + a[1], b[5] + a[2]}};
}

#endif

}  // namespace breccia::dem
