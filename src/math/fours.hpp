#pragma once
// Records of four numbers, doubles or floats, and records of floats: read and written by packs.

#include "math/lanes.hpp"

namespace breccia {

#if !defined(__CUDACC__) && defined(__AVX512F__)
/// Number k of each row of four floats becomes column k.
inline void columns_of_fours(const float* const (&row)[8], Pack8 (&columns)[4]) {
  const auto beside = [&](int k) {
    return _mm512_cvtps_pd(_mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(row[k])),
                                                _mm_loadu_ps(row[k + 2]), 1));
  };
  const __m512d r02 = beside(0), r13 = beside(1), r46 = beside(4), r57 = beside(5);
  const __m512d low = _mm512_unpacklo_pd(r02, r13), high = _mm512_unpackhi_pd(r02, r13);
  const __m512d low_b = _mm512_unpacklo_pd(r46, r57), high_b = _mm512_unpackhi_pd(r46, r57);
  columns[0] = _mm512_shuffle_f64x2(low, low_b, 0x88);
  columns[1] = _mm512_shuffle_f64x2(high, high_b, 0x88);
  columns[2] = _mm512_shuffle_f64x2(low, low_b, 0xdd);
  columns[3] = _mm512_shuffle_f64x2(high, high_b, 0xdd);
}
/// Rows of four floats, rounded to the nearest, from columns.
inline void write_fours(const Pack8 (&columns)[4], float* to) {
  const __m256 c0 = rounded(columns[0]), c1 = rounded(columns[1]), c2 = rounded(columns[2]),
               c3 = rounded(columns[3]);
  const __m256 low01 = _mm256_unpacklo_ps(c0, c1), high01 = _mm256_unpackhi_ps(c0, c1),
               low23 = _mm256_unpacklo_ps(c2, c3), high23 = _mm256_unpackhi_ps(c2, c3);
  const __m256 rows[4] = {
      _mm256_shuffle_ps(low01, low23, 0x44), _mm256_shuffle_ps(low01, low23, 0xee),
      _mm256_shuffle_ps(high01, high23, 0x44), _mm256_shuffle_ps(high01, high23, 0xee)};
  for (int j = 0; j < 4; ++j) {  // rows j and 4 + j
    _mm_storeu_ps(to + 4 * j, _mm256_castps256_ps128(rows[j]));
    _mm_storeu_ps(to + 4 * (4 + j), _mm256_extractf128_ps(rows[j], 1));
  }
}
#elif !defined(__CUDACC__) && defined(__AVX2__)
/// Number k of each row of four floats becomes column k.
inline void columns_of_fours(const float* const (&row)[4], Pack4 (&columns)[4]) {
  for (int k = 0; k < 4; ++k) columns[k] = _mm256_cvtps_pd(_mm_loadu_ps(row[k]));
  transpose(columns);
}
/// Rows of four floats, rounded to the nearest, from columns.
inline void write_fours(const Pack4 (&columns)[4], float* to) {
  __m128 rows[4];
  for (int k = 0; k < 4; ++k) rows[k] = rounded(columns[k]);
  _MM_TRANSPOSE4_PS(rows[0], rows[1], rows[2], rows[3]);
  for (int k = 0; k < 4; ++k) _mm_storeu_ps(to + 4 * k, rows[k]);
}
#endif

#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
/// Number k of record at[i] becomes number i of column k.
template <int count, class Record>
inline void columns_of_floats(const View<const Record>& records,
                              const Index (&at)[width_of<SinglePack>],
                              SinglePack (&columns)[count]) {
  static_assert(count % 4 == 0 && count >= 8);
  for (int done = 0; done < count; done += 8) {
    const int first = done + 8 <= count ? done : count - 8;  // some twice
    __m256 rows[width_of<SinglePack>];
    for (Index i = 0; i < width_of<SinglePack>; ++i)
      rows[i] = _mm256_loadu_ps(reinterpret_cast<const float*>(records.data + at[i]) + first);
    SinglePack eight[8];
    columns_of(rows, eight);
    for (int k = 0; k < 8; ++k) columns[first + k] = eight[k];
  }
}
#endif

/// Constants in single precision of a law, for each item: columns[k] is number k of record at[.].
/// Laws of neighbours are alike, nearly always.
template <int count, class Record, class R>
BR_HD inline void gather_floats(const View<const Record>& records, const Index (&at)[width_of<R>],
                                R (&columns)[count]) {
  static_assert(sizeof(Record) == count * sizeof(float) && count % 4 == 0);
#if defined(__CUDA_ARCH__)
  const auto* fours = reinterpret_cast<const float4*>(&records[at[0]]);
  for (int k = 0; k < count / 4; ++k) {
    const float4 four = fours[k];
    columns[4 * k] = R(four.x);
    columns[4 * k + 1] = R(four.y);
    columns[4 * k + 2] = R(four.z);
    columns[4 * k + 3] = R(four.w);
  }
#else
  Index unlike = 0;
  for (Index i = 1; i < width_of<R>; ++i) unlike |= at[i] ^ at[0];
  if constexpr (width_of<R> != 1)
    if (unlike != 0) return columns_of_floats(records, at, columns);
  const auto* numbers = reinterpret_cast<const float*>(&records[at[0]]);
  for (int k = 0; k < count; ++k) columns[k] = R(numbers[k]);
#endif
}

/// gather_records where records are of four doubles or floats.
template <class Number, class Record, class R>
BR_HD inline void gather_four(const View<const Record>& records, const Indices<R>& i,
                              R (&columns)[4]) {
  static_assert(sizeof(Record) == 4 * sizeof(Number));
  if constexpr (sizeof(Number) == sizeof(double)) {
    gather_records(records, i, columns);
  } else if constexpr (width_of<R> != 1) {
    const float* row[width_of<R>];
    for (Index k = 0; k < width_of<R>; ++k)
      row[k] = reinterpret_cast<const float*>(records.data + i.at[k]);
    columns_of_fours(row, columns);
  } else {
    Index at[width_of<R>];
    __builtin_memcpy(at, &i, sizeof at);
    double numbers[4][width_of<R>];
    for (Index k = 0; k < width_of<R>; ++k) {
      const auto* from = reinterpret_cast<const Number*>(&records[at[k]]);
      for (int c = 0; c < 4; ++c) numbers[c][k] = from[c];
    }
    for (int c = 0; c < 4; ++c) columns[c] = pack_of<R>(numbers[c]);
  }
}
/// Stores four columns as records of four; floats are rounded to the nearest.
template <class Number, class Record, class R>
BR_HD inline void store_four(const View<Record>& records, Index first, const R (&columns)[4]) {
  static_assert(sizeof(Record) == 4 * sizeof(Number));
  if constexpr (is_single<R>) {
    BR_ASSERT(first >= 0 && first + width_of<R> <= records.size);
    write_fours(columns, reinterpret_cast<float*>(&records[first]));
  } else if constexpr (sizeof(Number) == sizeof(double)) {
    store_records(records, first, columns);
  } else if constexpr (width_of<R> != 1) {
    BR_ASSERT(first >= 0 && first + width_of<R> <= records.size);
    write_fours(columns, reinterpret_cast<float*>(&records[first]));
  } else {
    double numbers[4][width_of<R>];
    __builtin_memcpy(numbers, &columns, sizeof numbers);
    for (Index k = 0; k < width_of<R>; ++k) {
      Number own[4];
      for (int c = 0; c < 4; ++c) own[c] = static_cast<Number>(numbers[c][k]);
      __builtin_memcpy(&records[first + k], own, sizeof own);
    }
  }
}

}  // namespace breccia
