#pragma once
// Loading, storing and gathering packs: how kernels written for one item or several reach their
// arrays.

#include "exec/buffer.hpp"
#include "math/vec.hpp"

namespace breccia {

/// Items first, first + 1, ... of an array.
template <class R, class T>
BR_HD inline R load(const View<T>& array, Index first) {
  if constexpr (width_of<R> == 1) {
    return array[first];
  } else {
    BR_ASSERT(first >= 0 && first + width_of<R> <= array.size);
    R pack;
    __builtin_memcpy(&pack, array.data + first, sizeof pack);
    return pack;
  }
}
template <class R>
BR_HD inline void store(const View<double>& array, Index first, const R& value) {
  if constexpr (width_of<R> == 1) {
    array[first] = value;
  } else {
    BR_ASSERT(first >= 0 && first + width_of<R> <= array.size);
    __builtin_memcpy(array.data + first, &value, sizeof value);
  }
}

/// Indices of the elements that the items of a pack meet.
template <class R>
struct Indices;
template <>
struct Indices<double> {
  Index at;
};
template <class R>
BR_HD inline Indices<R> load_indices(const View<const Index>& array, Index first);
template <>
BR_HD inline Indices<double> load_indices<double>(const View<const Index>& array, Index first) {
  return {array[first]};
}

/// Reads record i of an array of records of `count` doubles, for each index of a pack: columns[k]
/// is number k of every record.
template <int count, class Record>
BR_HD inline void gather_records(const View<const Record>& records, Indices<double> i,
                                 double (&columns)[count]) {
  static_assert(sizeof(Record) == count * sizeof(double));
  const auto* numbers = reinterpret_cast<const double*>(&records[i.at]);
  for (int k = 0; k < count; ++k) columns[k] = numbers[k];
}

#if !defined(__CUDACC__) && defined(__AVX512F__)

template <>
struct Indices<Pack8> {
  Index at[8];
};
template <>
inline Indices<Pack8> load_indices<Pack8>(const View<const Index>& array, Index first) {
  Indices<Pack8> indices;
  __builtin_memcpy(indices.at, array.data + first, sizeof indices.at);
  return indices;
}
template <int count, class Record>
inline void gather_records(const View<const Record>& records, const Indices<Pack8>& i,
                           Pack8 (&columns)[count]) {
  static_assert(sizeof(Record) == count * sizeof(double));
  static_assert(count == 10, "eight numbers by a full transposition, two more by pairs");
  const double* row[8];
  Pack8 rows[8];
  for (int k = 0; k < 8; ++k) {
    row[k] = reinterpret_cast<const double*>(records.data + i.at[k]);
    __builtin_memcpy(&rows[k], row[k], sizeof rows[k]);
  }
  transpose(rows);
  for (int k = 0; k < 8; ++k) columns[k] = rows[k];
  const auto tail = [&](int first) {  // the last two numbers of every other record
    __m512d pairs = _mm512_castpd128_pd512(_mm_loadu_pd(row[first] + 8));
    pairs = _mm512_insertf64x2(pairs, _mm_loadu_pd(row[first + 2] + 8), 1);
    pairs = _mm512_insertf64x2(pairs, _mm_loadu_pd(row[first + 4] + 8), 2);
    return _mm512_insertf64x2(pairs, _mm_loadu_pd(row[first + 6] + 8), 3);
  };
  const __m512d even = tail(0), odd = tail(1);
  columns[8] = _mm512_unpacklo_pd(even, odd);
  columns[9] = _mm512_unpackhi_pd(even, odd);
}

#elif !defined(__CUDACC__) && defined(__AVX2__)

template <>
struct Indices<Pack4> {
  Index at[4];
};
template <>
inline Indices<Pack4> load_indices<Pack4>(const View<const Index>& array, Index first) {
  Indices<Pack4> indices;
  __builtin_memcpy(indices.at, array.data + first, sizeof indices.at);
  return indices;
}
template <int count, class Record>
inline void gather_records(const View<const Record>& records, const Indices<Pack4>& i,
                           Pack4 (&columns)[count]) {
  static_assert(sizeof(Record) == count * sizeof(double));
  static_assert(count == 10, "twice four numbers by transpositions, two more by pairs");
  const double* row[4];
  for (int k = 0; k < 4; ++k) row[k] = reinterpret_cast<const double*>(records.data + i.at[k]);
  for (int part = 0; part < 2; ++part) {
    Pack4 rows[4];
    for (int k = 0; k < 4; ++k) __builtin_memcpy(&rows[k], row[k] + 4 * part, sizeof rows[k]);
    transpose(rows);
    for (int k = 0; k < 4; ++k) columns[4 * part + k] = rows[k];
  }
  const auto tail = [&](int first) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(row[first] + 8)),
                                _mm_loadu_pd(row[first + 2] + 8), 1);
  };
  const __m256d even = tail(0), odd = tail(1);
  columns[8] = _mm256_unpacklo_pd(even, odd);
  columns[9] = _mm256_unpackhi_pd(even, odd);
}

#endif

}  // namespace breccia
