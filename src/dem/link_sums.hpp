#pragma once
// What links add up to at an element, and its totals: one element or a pack of neighbours at a
// time.

#include "math/lanes.hpp"

namespace breccia::dem {

/// What the concrete links of an element have added up to so far. Zero between two steps.
struct LinkSums {
  SixSums as_b;              ///< force, then torque, of links that end at the element  [N, N m]
  SixFloatSums stiffness_b;  ///< K, then K^theta  [N/m, N m]
  SixSums as_a;              ///< torque, then minus the force, of links that start there
  SixFloatSums stiffness_a;  ///< K^theta, then K
};
static_assert(sizeof(LinkSums) == 144);

/// What an element gets from all its sums.
template <class R>
struct TotalsOf {
  Vec3Of<R> force, torque;  ///<  [N], [N m]
  R straight, turning;      ///< largest stiffness of a free coordinate  [N/m], [N m]
};

/// @param fixed  coordinates that are not free, bits of Fixed
BR_HD inline TotalsOf<double> totals_of(const LinkSums& s, int fixed) {
  float straight = 0.0F, turning = 0.0F;
  for (int c = 0; c < 3; ++c) {
    const float k = s.stiffness_a[3 + c] + s.stiffness_b[c];
    const float k_theta = s.stiffness_a[c] + s.stiffness_b[3 + c];
    if ((fixed >> c & 1) == 0 && k > straight) straight = k;
    if ((fixed >> (3 + c) & 1) == 0 && k_theta > turning) turning = k_theta;
  }
  return {{s.as_b[0] - s.as_a[3], s.as_b[1] - s.as_a[4], s.as_b[2] - s.as_a[5]},
          {s.as_b[3] + s.as_a[0], s.as_b[4] + s.as_a[1], s.as_b[5] + s.as_a[2]},
          static_cast<double>(straight),
          static_cast<double>(turning)};
}

/// Vectors first, first + 1, ... of an array, written.
BR_HD inline void store_vectors(const View<Vec3>& vectors, Index first, const Vec3& v) {
  vectors[first] = v;
}

/// Totals of element e and its neighbours in a pack, taken one by one.
template <class R>
BR_HD TotalsOf<R> totals_in_turn(const View<LinkSums>& sums, const View<const std::uint8_t>& fixed,
                                 Index e) {
  constexpr Index width = width_of<R>;
  double numbers[8][width];
  for (Index k = 0; k < width; ++k) {
    const TotalsOf<double> t = totals_of(sums[e + k], fixed[e + k]);
    const double own[8] = {t.force.x,  t.force.y,  t.force.z,  t.torque.x,
                           t.torque.y, t.torque.z, t.straight, t.turning};
    for (int c = 0; c < 8; ++c) numbers[c][k] = own[c];
  }
  return {{pack_of<R>(numbers[0]), pack_of<R>(numbers[1]), pack_of<R>(numbers[2])},
          {pack_of<R>(numbers[3]), pack_of<R>(numbers[4]), pack_of<R>(numbers[5])},
          pack_of<R>(numbers[6]),
          pack_of<R>(numbers[7])};
}

template <class R>
BR_HD TotalsOf<R> totals(const View<LinkSums>& sums, const View<const std::uint8_t>& fixed,
                         Index e) {
  return totals_in_turn<R>(sums, fixed, e);
}

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

/// Eight at once, if all are free.
template <>
inline TotalsOf<Pack8> totals<Pack8>(const View<LinkSums>& sums,
                                     const View<const std::uint8_t>& fixed, Index e) {
  std::uint64_t held = 0;
  __builtin_memcpy(&held, fixed.data + e, sizeof held);
  if (held != 0) return totals_in_turn<Pack8>(sums, fixed, e);
  Pack8 c[18];  // of each two stiffnesses make one column
  gather_records(View<const LinkSums>(sums), consecutive<Pack8>(e), c);
  const Pack8* const b = c;
  const Pack8* const a = c + 9;
  // Number `one` of columns p, q, counted through both, for all elements; then number `other`.
  const auto two = [](Pack8 p, Pack8 q, int one, int other) {
    const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 0, 2, 4, 6, 8, 10, 12, 14);
    const auto shift = [](int number) { return number % 2 + 16 * (number / 2); };
    const __m512i places = _mm512_add_epi32(
        even,
        _mm512_inserti64x4(_mm512_set1_epi32(shift(one)), _mm256_set1_epi32(shift(other)), 1));
    return _mm512_permutex2var_ps(_mm512_castpd_ps(p), places, _mm512_castpd_ps(q));
  };
  const __m512 straight01 = two(a[7], a[8], 1, 2) + two(b[6], b[6], 0, 1);
  const __m512 straight2_turning0 = two(a[8], a[6], 1, 2) + two(b[7], b[7], 0, 1);
  const __m512 turning12 = two(a[6], a[7], 1, 2) + two(b[8], b[8], 0, 1);
  const auto low = [](__m512 pair) { return _mm512_castps512_ps256(pair); };
  const auto high = [](__m512 pair) { return _mm512_extractf32x8_ps(pair, 1); };
  // As k > largest ? k : largest, from zero on.
  const auto stiffest = [](__m256 k0, __m256 k1, __m256 k2) {
    const __m256 first = _mm256_max_ps(k0, _mm256_setzero_ps());
    return Pack8(_mm512_cvtps_pd(_mm256_max_ps(k2, _mm256_max_ps(k1, first))));
  };
  return {{b[0] - a[3], b[1] - a[4], b[2] - a[5]},
          {b[3] + a[0], b[4] + a[1], b[5] + a[2]},
          stiffest(low(straight01), high(straight01), low(straight2_turning0)),
          stiffest(high(straight2_turning0), low(turning12), high(turning12))};
}

#elif !defined(__CUDACC__) && defined(__AVX2__)

inline void store_vectors(const View<Vec3>& vectors, Index first, const Vec3Of<Pack4>& v) {
  for (Index k = 0; k < 4; ++k) vectors[first + k] = {v.x[k], v.y[k], v.z[k]};
}

#endif

}  // namespace breccia::dem
