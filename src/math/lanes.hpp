#pragma once
// Loading, storing and gathering packs: how kernels written for one item or several reach their
// arrays.

#include "exec/buffer.hpp"
#include "exec/early.hpp"
#include "math/single.hpp"
#include "math/vec.hpp"

namespace breccia {

/// Items first, first + 1, ... of an array of doubles, not rounded to R.
template <class R, class T>
BR_HD inline Wide<R> load_wide(const View<T>& array, Index first) {
  if constexpr (width_of<R> == 1) {
    return array[first];
  } else {
    BR_ASSERT(first >= 0 && first + width_of<R> <= array.size);
    Wide<R> packs;
    __builtin_memcpy(&packs, array.data + first, sizeof packs);
    return packs;
  }
}
/// Items first, first + 1, ... of an array of doubles or floats.
template <class R, class T>
BR_HD inline R load(const View<T>& array, Index first) {
  if constexpr (width_of<R> == 1) {
    return R(array[first]);
  } else if constexpr (is_single<R> && sizeof(T) == sizeof(float)) {
    BR_ASSERT(first >= 0 && first + width_of<R> <= array.size);
    R pack;
    __builtin_memcpy(&pack, array.data + first, sizeof pack);
    return pack;
  } else if constexpr (is_single<R>) {
    return narrowed(load_wide<R>(array, first));
  } else if constexpr (sizeof(T) == sizeof(float)) {
    BR_ASSERT(first >= 0 && first + width_of<R> <= array.size);
    typename TypesOf<R>::Single single;
    __builtin_memcpy(&single, array.data + first, sizeof single);
    return __builtin_convertvector(single, R);
  } else {
    BR_ASSERT(first >= 0 && first + width_of<R> <= array.size);
    R pack;
    __builtin_memcpy(&pack, array.data + first, sizeof pack);
    return pack;
  }
}
template <class R>
BR_HD inline void store(const View<double>& array, Index first, const R& value) {
  if constexpr (is_single<R> && width_of<R> == 1) {
    array[first] = widened(value);
  } else if constexpr (width_of<R> == 1) {
    array[first] = value;
  } else if constexpr (is_single<R>) {
    BR_ASSERT(first >= 0 && first + width_of<R> <= array.size);
    const auto wide = widened(value);
    __builtin_memcpy(array.data + first, &wide, sizeof wide);
  } else {
    BR_ASSERT(first >= 0 && first + width_of<R> <= array.size);
    __builtin_memcpy(array.data + first, &value, sizeof value);
  }
}
/// Rounded to the nearest.
template <class R>
BR_HD inline void store(const View<float>& array, Index first, const R& value) {
  if constexpr (is_single<R>) {
    BR_ASSERT(first >= 0 && first + width_of<R> <= array.size);
    __builtin_memcpy(array.data + first, &value, sizeof value);
  } else if constexpr (width_of<R> == 1) {
    array[first] = static_cast<float>(value);
  } else {
    BR_ASSERT(first >= 0 && first + width_of<R> <= array.size);
    const auto single = __builtin_convertvector(value, typename TypesOf<R>::Single);
    __builtin_memcpy(array.data + first, &single, sizeof single);
  }
}

/// Adds to items first, first + 1, ... of an array of doubles, in double.
template <class R>
BR_HD inline void add_to(const View<double>& array, Index first, const R& more) {
  if constexpr (is_single<R>) {
    const Wide<R> sum = load_wide<R>(array, first) + widened(more);
    __builtin_memcpy(array.data + first, &sum, sizeof sum);
  } else {
    store(array, first, load<R>(array, first) + more);
  }
}

/// Indices of the elements that the items of a pack meet.
template <class R>
struct Indices;
template <>
struct Indices<double> {
  Index at;
};
template <>
struct Indices<Single> : Indices<double> {};
template <class R>
BR_HD inline Indices<R> load_indices(const View<const Index>& array, Index first);
template <>
BR_HD inline Indices<double> load_indices<double>(const View<const Index>& array, Index first) {
  return {array[first]};
}
template <>
BR_HD inline Indices<Single> load_indices<Single>(const View<const Index>& array, Index first) {
  return {{array[first]}};
}

/// load() and load_indices() where these calls stand: a device may wait between them for the launch
/// before.
template <class R, class T>
BR_HD inline R load_now(const View<T>& array, Index first) {
  if constexpr (width_of<R> == 1)
    return R(read_now(&array[first]));
  else
    return load<R>(array, first);
}
template <class R, class T>
BR_HD inline Wide<R> load_wide_now(const View<T>& array, Index first) {
  if constexpr (width_of<R> == 1)
    return read_now(&array[first]);
  else
    return load_wide<R>(array, first);
}
template <class R>
BR_HD inline Indices<R> load_indices_now(const View<const Index>& array, Index first) {
  Indices<R> indices;
  if constexpr (width_of<R> == 1)
    indices.at = read_now(&array[first]);
  else
    indices = load_indices<R>(array, first);
  return indices;
}

/// Reads the first `count` doubles of record i of an array, for each index of a pack: columns[k] is
/// number k of every record.
template <int count, class Record>
BR_HD inline void gather_records(const View<const Record>& records, Indices<double> i,
                                 double (&columns)[count]) {
  static_assert(sizeof(Record) >= count * sizeof(double));
#if defined(__CUDA_ARCH__)
  static_assert(count % 2 == 0);  // and arrays are aligned: two numbers a load
  const auto* twos = reinterpret_cast<const double2*>(&records[i.at]);
  for (int k = 0; k < count / 2; ++k) {
    const double2 two = twos[k];
    columns[2 * k] = two.x;
    columns[2 * k + 1] = two.y;
  }
#else
  const auto* numbers = reinterpret_cast<const double*>(&records[i.at]);
  for (int k = 0; k < count; ++k) columns[k] = numbers[k];
#endif
}

/// Gathers records where this call stands (load_now); records are of `count` doubles.
template <int count, class Record, class R>
BR_HD inline void gather_records_now(const View<const Record>& records, const Indices<R>& i,
                                     R (&columns)[count]) {
  if constexpr (width_of<R> == 1) {
    static_assert(sizeof(Record) == count * sizeof(double));
    const Record record = read_record_now(&records[i.at]);
    __builtin_memcpy(columns, &record, sizeof record);
  } else {
    gather_records(records, i, columns);
  }
}

/// Writes numbers k of records first, first + 1, ... from columns[k].
template <int count, class Record>
BR_HD inline void store_records(const View<Record>& records, Index first,
                                const double (&columns)[count]) {
  static_assert(sizeof(Record) == count * sizeof(double));
#if defined(__CUDA_ARCH__)
  static_assert(count % 2 == 0);
  auto* twos = reinterpret_cast<double2*>(&records[first]);
  for (int k = 0; k < count / 2; ++k) twos[k] = make_double2(columns[2 * k], columns[2 * k + 1]);
#else
  auto* numbers = reinterpret_cast<double*>(&records[first]);
  for (int k = 0; k < count; ++k) numbers[k] = columns[k];
#endif
}

/// Vectors first, first + 1, ... of an array.
template <class R>
BR_HD inline Vec3Of<R> load_vectors(const View<const Vec3>& vectors, Index first);
template <>
BR_HD inline Vec3 load_vectors<double>(const View<const Vec3>& vectors, Index first) {
  return vectors[first];
}

/// Loads vectors where this call stands (load_now).
template <class R>
BR_HD inline Vec3Of<R> load_vectors_now(const View<const Vec3>& vectors, Index first) {
  if constexpr (width_of<R> == 1) {
    const Vec3& v = vectors[first];
    return {read_now(&v.x), read_now(&v.y), read_now(&v.z)};
  } else {
    return load_vectors<R>(vectors, first);
  }
}

/// A whole record of doubles, read and written two numbers at a time on a device.
template <class Record>
BR_HD inline Record read_record(const View<const Record>& records, Index i) {
#if defined(__CUDA_ARCH__)
  double numbers[sizeof(Record) / sizeof(double)];
  gather_records(records, Indices<double>{i}, numbers);
  Record record;
  __builtin_memcpy(&record, numbers, sizeof record);
  return record;
#else
  return records[i];
#endif
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
template <>
inline Vec3Of<Pack8> load_vectors<Pack8>(const View<const Vec3>& vectors, Index first) {
  BR_ASSERT(first >= 0 && first + 8 <= vectors.size);
  const auto* numbers = reinterpret_cast<const double*>(vectors.data + first);
  const __m512d a = _mm512_loadu_pd(numbers), b = _mm512_loadu_pd(numbers + 8),
                c = _mm512_loadu_pd(numbers + 16);
  const auto every_third = [&](__m512i of_ab, __m512i with_c) {
    return _mm512_permutex2var_pd(_mm512_permutex2var_pd(a, of_ab, b), with_c, c);
  };
  return {every_third(_mm512_setr_epi64(0, 3, 6, 9, 12, 15, 0, 0),
                      _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 10, 13)),
          every_third(_mm512_setr_epi64(1, 4, 7, 10, 13, 0, 0, 0),
                      _mm512_setr_epi64(0, 1, 2, 3, 4, 8, 11, 14)),
          every_third(_mm512_setr_epi64(2, 5, 8, 11, 14, 0, 0, 0),
                      _mm512_setr_epi64(0, 1, 2, 3, 4, 9, 12, 15))};
}
template <int count, class Record>
inline void gather_records(const View<const Record>& records, const Indices<Pack8>& i,
                           Pack8 (&columns)[count]) {
  static_assert(sizeof(Record) >= count * sizeof(double) && count % 2 == 0);
  const double* row[8];
  for (int k = 0; k < 8; ++k) row[k] = reinterpret_cast<const double*>(records.data + i.at[k]);
  constexpr int eights = count / 8 * 8, fours = count / 4 * 4;
  for (int first = 0; first < eights; first += 8) {
    Pack8 rows[8];
    for (int k = 0; k < 8; ++k) __builtin_memcpy(&rows[k], row[k] + first, sizeof rows[k]);
    transpose(rows);
    for (int k = 0; k < 8; ++k) columns[first + k] = rows[k];
  }
  if constexpr (fours > eights) {  // rows k and k + 2 side by side
    const auto beside = [&](int k) {
      return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(row[k] + eights)),
                                _mm256_loadu_pd(row[k + 2] + eights), 1);
    };
    const __m512d r02 = beside(0), r13 = beside(1), r46 = beside(4), r57 = beside(5);
    const __m512d low = _mm512_unpacklo_pd(r02, r13), high = _mm512_unpackhi_pd(r02, r13);
    const __m512d low_b = _mm512_unpacklo_pd(r46, r57), high_b = _mm512_unpackhi_pd(r46, r57);
    columns[eights] = _mm512_shuffle_f64x2(low, low_b, 0x88);
    columns[eights + 1] = _mm512_shuffle_f64x2(high, high_b, 0x88);
    columns[eights + 2] = _mm512_shuffle_f64x2(low, low_b, 0xdd);
    columns[eights + 3] = _mm512_shuffle_f64x2(high, high_b, 0xdd);
  }
  if constexpr (count > fours) {
    const auto tail = [&](int first) {  // the last two numbers of every other record
      __m512d pairs = _mm512_castpd128_pd512(_mm_loadu_pd(row[first] + fours));
      pairs = _mm512_insertf64x2(pairs, _mm_loadu_pd(row[first + 2] + fours), 1);
      pairs = _mm512_insertf64x2(pairs, _mm_loadu_pd(row[first + 4] + fours), 2);
      return _mm512_insertf64x2(pairs, _mm_loadu_pd(row[first + 6] + fours), 3);
    };
    const __m512d even = tail(0), odd = tail(1);
    columns[fours] = _mm512_unpacklo_pd(even, odd);
    columns[fours + 1] = _mm512_unpackhi_pd(even, odd);
  }
}
template <int count, class Record>
inline void store_records(const View<Record>& records, Index first, const Pack8 (&columns)[count]) {
  static_assert(sizeof(Record) == count * sizeof(double) && count % 2 == 0);
  auto* to = reinterpret_cast<double*>(records.data + first);
  for (int k = 0; k < count; k += 2) {
    const __m512d even = _mm512_unpacklo_pd(columns[k], columns[k + 1]);
    const __m512d odd = _mm512_unpackhi_pd(columns[k], columns[k + 1]);
    _mm_storeu_pd(to + k, _mm512_extractf64x2_pd(even, 0));
    _mm_storeu_pd(to + count + k, _mm512_extractf64x2_pd(odd, 0));
    _mm_storeu_pd(to + 2 * count + k, _mm512_extractf64x2_pd(even, 1));
    _mm_storeu_pd(to + 3 * count + k, _mm512_extractf64x2_pd(odd, 1));
    _mm_storeu_pd(to + 4 * count + k, _mm512_extractf64x2_pd(even, 2));
    _mm_storeu_pd(to + 5 * count + k, _mm512_extractf64x2_pd(odd, 2));
    _mm_storeu_pd(to + 6 * count + k, _mm512_extractf64x2_pd(even, 3));
    _mm_storeu_pd(to + 7 * count + k, _mm512_extractf64x2_pd(odd, 3));
  }
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
template <>
inline Vec3Of<Pack4> load_vectors<Pack4>(const View<const Vec3>& vectors, Index first) {
  const auto pack = [&](double Vec3::*component) {
    return Pack4{vectors[first].*component, vectors[first + 1].*component,
                 vectors[first + 2].*component, vectors[first + 3].*component};
  };
  return {pack(&Vec3::x), pack(&Vec3::y), pack(&Vec3::z)};
}
template <int count, class Record>
inline void gather_records(const View<const Record>& records, const Indices<Pack4>& i,
                           Pack4 (&columns)[count]) {
  static_assert(sizeof(Record) >= count * sizeof(double) && count % 2 == 0);
  const double* row[4];
  for (int k = 0; k < 4; ++k) row[k] = reinterpret_cast<const double*>(records.data + i.at[k]);
  constexpr int fours = count / 4 * 4;
  for (int first = 0; first < fours; first += 4) {
    Pack4 rows[4];
    for (int k = 0; k < 4; ++k) __builtin_memcpy(&rows[k], row[k] + first, sizeof rows[k]);
    transpose(rows);
    for (int k = 0; k < 4; ++k) columns[first + k] = rows[k];
  }
  if constexpr (count > fours) {
    const auto tail = [&](int first) {
      return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(row[first] + fours)),
                                  _mm_loadu_pd(row[first + 2] + fours), 1);
    };
    const __m256d even = tail(0), odd = tail(1);
    columns[fours] = _mm256_unpacklo_pd(even, odd);
    columns[fours + 1] = _mm256_unpackhi_pd(even, odd);
  }
}
template <int count, class Record>
inline void store_records(const View<Record>& records, Index first, const Pack4 (&columns)[count]) {
  static_assert(sizeof(Record) == count * sizeof(double) && count % 2 == 0);
  auto* to = reinterpret_cast<double*>(records.data + first);
  for (int k = 0; k < count; k += 2) {
    const __m256d even = _mm256_unpacklo_pd(columns[k], columns[k + 1]);
    const __m256d odd = _mm256_unpackhi_pd(columns[k], columns[k + 1]);
    _mm_storeu_pd(to + k, _mm256_castpd256_pd128(even));
    _mm_storeu_pd(to + count + k, _mm256_castpd256_pd128(odd));
    _mm_storeu_pd(to + 2 * count + k, _mm256_extractf128_pd(even, 1));
    _mm_storeu_pd(to + 3 * count + k, _mm256_extractf128_pd(odd, 1));
  }
}

#endif

#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
/// They stay in memory.
template <>
struct Indices<SinglePack> {
  const Index* first;
  Index at(Index k) const { return first[k]; }
};
template <>
inline Indices<SinglePack> load_indices<SinglePack>(const View<const Index>& array, Index first) {
  BR_ASSERT(first >= 0 && first + width_of<SinglePack> <= array.size);
  return {array.data + first};
}
#endif

/// Numbers given one by one.
template <class R>
BR_HD inline R pack_of(const double (&numbers)[width_of<R>]) {
  R pack;
  __builtin_memcpy(&pack, numbers, sizeof pack);
  return pack;
}
/// Indices given one by one, and copied so: a load of several waits until the store of each has
/// reached the cache, and all that follows with it.
template <class R>
BR_HD inline Indices<R> indices(const Index (&at)[width_of<R>]) {
  Indices<R> i;
  if constexpr (width_of<R> == 1) {
    i.at = at[0];
  } else {
    for (Index k = 0; k < width_of<R>; ++k) i.at[k] = at[k];
  }
  return i;
}
/// first, first + 1, ...
template <class R>
BR_HD inline Indices<R> consecutive(Index first) {
  Indices<R> i;
  if constexpr (width_of<R> == 1) {
    i.at = first;
  } else {
    for (Index k = 0; k < width_of<R>; ++k) i.at[k] = first + k;
  }
  return i;
}

}  // namespace breccia
