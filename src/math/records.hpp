#pragma once
// Records of doubles that lie side by side, read and written by packs.

#include "math/lanes.hpp"

namespace breccia {

/// Reads records first, first + 1, ... of an array, of `count` doubles each: columns[k] is number k
/// of every record. As gather_records, with one address for all.
template <int count, class R, class Record>
BR_HD inline void load_records(const View<Record>& records, Index first, R (&columns)[count]) {
  static_assert(sizeof(Record) == count * sizeof(double));
  if constexpr (width_of<R> == 1) {
    gather_records(View<const Record>(records), Indices<double>{first}, columns);
  } else {
    BR_ASSERT(first >= 0 && first + width_of<R> <= records.size);
#if !defined(__CUDACC__) && defined(__AVX512F__)
    const auto* from = reinterpret_cast<const double*>(records.data + first);
    if constexpr (count == 8) {
      for (int k = 0; k < 8; ++k) __builtin_memcpy(&columns[k], from + 8 * k, sizeof columns[k]);
      transpose(columns);
      return;
    } else if constexpr (count == 4) {  // two records a pack
      const __m512d r01 = _mm512_loadu_pd(from), r23 = _mm512_loadu_pd(from + 8);
      const __m512d r45 = _mm512_loadu_pd(from + 16), r67 = _mm512_loadu_pd(from + 24);
      const __m512i low = _mm512_setr_epi64(0, 4, 8, 12, 1, 5, 9, 13);
      const __m512i high = _mm512_setr_epi64(2, 6, 10, 14, 3, 7, 11, 15);
      const __m512d a = _mm512_permutex2var_pd(r01, low, r23);
      const __m512d b = _mm512_permutex2var_pd(r45, low, r67);
      const __m512d c = _mm512_permutex2var_pd(r01, high, r23);
      const __m512d d = _mm512_permutex2var_pd(r45, high, r67);
      columns[0] = _mm512_shuffle_f64x2(a, b, 0x44);
      columns[1] = _mm512_shuffle_f64x2(a, b, 0xee);
      columns[2] = _mm512_shuffle_f64x2(c, d, 0x44);
      columns[3] = _mm512_shuffle_f64x2(c, d, 0xee);
      return;
    } else
#endif
      gather_records(View<const Record>(records), consecutive<R>(first), columns);
  }
}

/// gather_records for an odd number of doubles, the whole record.
template <int count, class Record, class R>
BR_HD inline void gather_odd(const View<const Record>& records, const Indices<R>& i,
                             R (&columns)[count]) {
  static_assert(sizeof(Record) == count * sizeof(double) && count % 2 == 1);
  gather_records(records, i, reinterpret_cast<R(&)[count - 1]>(columns));
  Index at[width_of<R>];
  __builtin_memcpy(at, &i, sizeof at);
  double last[width_of<R>];
  for (Index k = 0; k < width_of<R>; ++k)
    last[k] = reinterpret_cast<const double*>(&records[at[k]])[count - 1];
  columns[count - 1] = pack_of<R>(last);
}

/// Records without their first numbers, where they lie: no index may lead beyond the last of them.
template <int first, class Record>
BR_HD inline View<const Record> numbers_from(const View<const Record>& records) {
  View<const Record> rest = records;
  rest.data =
      reinterpret_cast<const Record*>(reinterpret_cast<const double*>(records.data) + first);
  return rest;
}

#if !defined(__CUDACC__) && defined(__AVX512F__)
/// Numbers 0 to 5 of records b less those of records a: columns[k] is number k of every pair.
template <class Record>
inline void gather_differences(const View<const Record>& records, const Indices<Pack8>& a,
                               const Indices<Pack8>& b, Pack8 (&columns)[6]) {
  static_assert(sizeof(Record) >= sizeof(Pack8));
  Pack8 rows[8];
  for (int k = 0; k < 8; ++k)
    rows[k] = _mm512_sub_pd(_mm512_loadu_pd(records.data + b.at[k]),
                            _mm512_loadu_pd(records.data + a.at[k]));
  transpose(rows);
  for (int k = 0; k < 6; ++k) columns[k] = rows[k];
}
#elif !defined(__CUDACC__) && defined(__AVX2__)
/// Numbers 0 to 5 of records b less those of records a: columns[k] is number k of every pair.
template <class Record>
inline void gather_differences(const View<const Record>& records, const Indices<Pack4>& a,
                               const Indices<Pack4>& b, Pack4 (&columns)[6]) {
  static_assert(sizeof(Record) >= 6 * sizeof(double));
  Pack4 rows[4];
  __m128d rest[4];
  for (int k = 0; k < 4; ++k) {
    const auto* const of_a = reinterpret_cast<const double*>(records.data + a.at[k]);
    const auto* const of_b = reinterpret_cast<const double*>(records.data + b.at[k]);
    rows[k] = _mm256_sub_pd(_mm256_loadu_pd(of_b), _mm256_loadu_pd(of_a));
    rest[k] = _mm_sub_pd(_mm_loadu_pd(of_b + 4), _mm_loadu_pd(of_a + 4));
  }
  transpose(rows);
  for (int k = 0; k < 4; ++k) columns[k] = rows[k];
  const __m256d even = _mm256_insertf128_pd(_mm256_castpd128_pd256(rest[0]), rest[2], 1);
  const __m256d odd = _mm256_insertf128_pd(_mm256_castpd128_pd256(rest[1]), rest[3], 1);
  columns[4] = _mm256_unpacklo_pd(even, odd);
  columns[5] = _mm256_unpackhi_pd(even, odd);
}
#endif

/// gather_records of the parts of records that lie side by side: part i of all of them.
template <class Record, class Part, int count, class R>
BR_HD inline void gather_parts(const View<const Record>& records, const Indices<R>& i,
                               R (&columns)[count]) {
  static_assert(sizeof(Record) % sizeof(Part) == 0);
  View<const Part> parts;
  parts.data = reinterpret_cast<const Part*>(records.data);
  parts.size = records.size * static_cast<Index>(sizeof(Record) / sizeof(Part));
  gather_records(parts, i, columns);
}

/// Writes records of an odd number of doubles, but those of which `others` has the bit.
template <int count, class R, class Record>
inline void store_odd_but(unsigned others, const View<Record>& records, Index first,
                          const R (&columns)[count]) {
  static_assert(sizeof(Record) == count * sizeof(double) && count % 2 == 1);
  struct Row {
    double number[count - 1];
  };
  Row rows[width_of<R>];
  View<Row> whole;
  whole.data = rows;
  whole.size = width_of<R>;
  store_records(whole, 0, reinterpret_cast<const R(&)[count - 1]>(columns));
  double last[width_of<R>];
  __builtin_memcpy(last, &columns[count - 1], sizeof last);
  for (Index k = 0; k < width_of<R>; ++k) {
    if ((others >> k & 1U) != 0) continue;
    auto* to = reinterpret_cast<double*>(&records[first + k]);
    __builtin_memcpy(to, &rows[k], sizeof rows[k]);
    to[count - 1] = last[k];
  }
}

/// Writes them: store_records by whole packs where records are as long as some or half of one.
template <int count, class R, class Record>
BR_HD inline void write_records(const View<Record>& records, Index first,
                                const R (&columns)[count]) {
#if !defined(__CUDACC__) && defined(__AVX512F__)
  if constexpr (width_of<R> == 8) {
    static_assert(sizeof(Record) == count * sizeof(double));
    BR_ASSERT(first >= 0 && first + 8 <= records.size);
    auto* to = reinterpret_cast<double*>(records.data + first);
    if constexpr (count >= 8 && count % 4 == 0) {
      constexpr int eights = count / 8 * 8;
      for (int eight = 0; eight < eights; eight += 8) {
        Pack8 rows[8];
        for (int k = 0; k < 8; ++k) rows[k] = columns[eight + k];
        transpose(rows);
        for (int k = 0; k < 8; ++k)
          __builtin_memcpy(to + count * k + eight, &rows[k], sizeof rows[k]);
      }
      if constexpr (eights < count) {  // halves of rows k and k + 2 side by side
        const Pack8* const c = columns + eights;
        const __m512d even_low = _mm512_unpacklo_pd(c[0], c[1]);
        const __m512d even_high = _mm512_unpacklo_pd(c[2], c[3]);
        const __m512d odd_low = _mm512_unpackhi_pd(c[0], c[1]);
        const __m512d odd_high = _mm512_unpackhi_pd(c[2], c[3]);
        const __m512i front = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
        const __m512i back = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
        const auto write = [&](int row, __m512d two_rows) {
          _mm256_storeu_pd(to + count * row + eights, _mm512_castpd512_pd256(two_rows));
          _mm256_storeu_pd(to + count * (row + 2) + eights, _mm512_extractf64x4_pd(two_rows, 1));
        };
        write(0, _mm512_permutex2var_pd(even_low, front, even_high));
        write(1, _mm512_permutex2var_pd(odd_low, front, odd_high));
        write(4, _mm512_permutex2var_pd(even_low, back, even_high));
        write(5, _mm512_permutex2var_pd(odd_low, back, odd_high));
      }
      return;
    } else if constexpr (count == 4) {
      const __m512i low = _mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11);
      const __m512i high = _mm512_setr_epi64(4, 12, 5, 13, 6, 14, 7, 15);
      const __m512d ab_low = _mm512_permutex2var_pd(columns[0], low, columns[1]);
      const __m512d ab_high = _mm512_permutex2var_pd(columns[0], high, columns[1]);
      const __m512d cd_low = _mm512_permutex2var_pd(columns[2], low, columns[3]);
      const __m512d cd_high = _mm512_permutex2var_pd(columns[2], high, columns[3]);
      const __m512i even = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
      const __m512i odd = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
      _mm512_storeu_pd(to, _mm512_permutex2var_pd(ab_low, even, cd_low));
      _mm512_storeu_pd(to + 8, _mm512_permutex2var_pd(ab_low, odd, cd_low));
      _mm512_storeu_pd(to + 16, _mm512_permutex2var_pd(ab_high, even, cd_high));
      _mm512_storeu_pd(to + 24, _mm512_permutex2var_pd(ab_high, odd, cd_high));
      return;
    }
  }
#endif
  store_records(records, first, columns);
}

}  // namespace breccia
