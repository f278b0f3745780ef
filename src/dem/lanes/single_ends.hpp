#pragma once
// How links that are computed in single precision read their ends.

#include "dem/lanes/link_ends.hpp"

namespace breccia::dem {

/// Both ends of a link that is computed in single precision, and how far it is stretched: all
/// differences are taken in double before they are rounded.
template <class V>
struct LinkPair<SingleOf<V>> {
  using R = SingleOf<V>;
  PairEnds<R> motion;
  R radii;   ///< sum of both  [m]
  R larger;  ///< radius of a less that of b  [m]
  R excess;  ///< D^2 - D_eq^2  [m2]

  BR_HD R touching() const { return radii; }
  BR_HD R difference() const { return larger; }
};
/// @param length  D_eq  [m]
BR_HD inline LinkPair<Single> single_pair(const LinkPair<double>& wide, double length) {
  const auto to_single = [](const Vec3& v) {
    return Vec3Of<Single>{narrowed(v.x), narrowed(v.y), narrowed(v.z)};
  };
  const PairEnds<double>& ends = wide.motion;
  return {{to_single(ends.way), to_single(ends.parting), to_single(ends.both_spins()),
           to_single(ends.turning())},
          narrowed(wide.touching()),
          narrowed(wide.difference()),
          narrowed(dot(ends.way, ends.way) - length * length)};
}
BR_HD inline LinkPair<Single> load_single_pair(const View<const ElementState>& state,
                                               const Indices<Single>& a, const Indices<Single>& b,
                                               double length) {
  return single_pair(load_pair<double>(state, a, b), length);
}

#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
/// The squared distances of as many pairs as a pack of doubles has, from the ways between them.
/// @param ways  three components each, and another number
inline WidestPack squared_distances(const __m256d* ways) {
#if defined(__AVX512F__)
  const auto beside = [&](int k) {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(ways[k]), ways[k + 2], 1);
  };
  const __m512d r02 = beside(0), r13 = beside(1), r46 = beside(4), r57 = beside(5);
  const __m512d low = _mm512_unpacklo_pd(r02, r13), high = _mm512_unpackhi_pd(r02, r13);
  const __m512d low_b = _mm512_unpacklo_pd(r46, r57), high_b = _mm512_unpackhi_pd(r46, r57);
  const WidestPack x = _mm512_shuffle_f64x2(low, low_b, 0x88);
  const WidestPack y = _mm512_shuffle_f64x2(high, high_b, 0x88);
  const WidestPack z = _mm512_shuffle_f64x2(low, low_b, 0xdd);
  return x * x + y * y + z * z;
#else
  WidestPack rows[4] = {ways[0], ways[1], ways[2], ways[3]};
  transpose(rows);
  return rows[0] * rows[0] + rows[1] * rows[1] + rows[2] * rows[2];
#endif
}
/// Records are subtracted and rounded as they lie in memory, then put in columns.
inline LinkPair<SinglePack> load_single_pair(const View<const ElementState>& state,
                                             const Indices<SinglePack>& a,
                                             const Indices<SinglePack>& b, const TwoPacks& length) {
  static_assert(sizeof(ElementState) == 10 * sizeof(double));  // place, velocity, spin, radius
  constexpr Index width = width_of<SinglePack>, half = width / 2;
  __m256d ways[width];
  __m256 first[width], last[width];
  for (Index k = 0; k < width; ++k) {
    const auto* const of_a = reinterpret_cast<const double*>(state.data + a.at(k));
    const auto* const of_b = reinterpret_cast<const double*>(state.data + b.at(k));
#if defined(__AVX512F__)
    const __m512d apart = _mm512_sub_pd(_mm512_loadu_pd(of_b), _mm512_loadu_pd(of_a));
    ways[k] = _mm512_castpd512_pd256(apart);
    first[k] = _mm512_cvtpd_ps(apart);
#else
    ways[k] = _mm256_sub_pd(_mm256_loadu_pd(of_b), _mm256_loadu_pd(of_a));
    const __m256d rest = _mm256_sub_pd(_mm256_loadu_pd(of_b + 4), _mm256_loadu_pd(of_a + 4));
    first[k] = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(ways[k])),
                                    _mm256_cvtpd_ps(rest), 1);
#endif
    const __m256d turning_a = _mm256_loadu_pd(of_a + 6), turning_b = _mm256_loadu_pd(of_b + 6);
    last[k] = _mm256_insertf128_ps(
        _mm256_castps128_ps256(_mm256_cvtpd_ps(_mm256_add_pd(turning_a, turning_b))),
        _mm256_cvtpd_ps(_mm256_sub_pd(turning_b, turning_a)), 1);
  }
  SinglePack moved[8], turned[8];
  columns_of(first, moved);
  columns_of(last, turned);
  TwoPacks excess = length * length;
  for (Index k = 0; k < 2; ++k)
    excess.half[k] = squared_distances(ways + half * k) - excess.half[k];
  return {{{moved[0], moved[1], moved[2]},
           {moved[3], moved[4], moved[5]},
           {turned[0], turned[1], turned[2]},
           {turned[4], turned[5], turned[6]}},
          turned[3],
          -turned[7],
          narrowed(excess)};
}
#endif

}  // namespace breccia::dem
