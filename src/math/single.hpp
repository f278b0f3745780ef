#pragma once
// Numbers that compute in single precision, one or several side by side, for kernels that are
// written for a type of number R. A plain float would turn double beside a constant.

#include <cstdint>
#include <type_traits>

#include "math/pack.hpp"

namespace breccia {

/// A number in single precision. Constants given in double are rounded to the nearest first.
/// @tparam V  float, or the compiler's vector of several
template <class V>
struct SingleOf {
  V v;

  SingleOf() = default;
  BR_HD explicit SingleOf(const V& value) : v(value) {}
  template <class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
  BR_HD explicit SingleOf(Number value) : v(V{} + static_cast<float>(value)) {}
};
using Single = SingleOf<float>;
template <class R>
inline constexpr bool is_single = false;
template <class V>
inline constexpr bool is_single<SingleOf<V>> = true;
static_assert(sizeof(Single) == sizeof(float));

#define BR_OF_SINGLE(op)                                                                    \
  template <class V>                                                                        \
  BR_HD inline auto operator op(const SingleOf<V>& a, const SingleOf<V>& b) {               \
    return BR_RESULT(a.v op b.v);                                                           \
  }                                                                                         \
  template <class V, class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0> \
  BR_HD inline auto operator op(const SingleOf<V>& a, Number b) {                           \
    return BR_RESULT(a.v op static_cast<float>(b));                                         \
  }                                                                                         \
  template <class V, class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0> \
  BR_HD inline auto operator op(Number a, const SingleOf<V>& b) {                           \
    return BR_RESULT(static_cast<float>(a) op b.v);                                         \
  }
#define BR_RESULT(value) SingleOf<V>(value)
BR_OF_SINGLE(+)
BR_OF_SINGLE(-)
BR_OF_SINGLE(*)
BR_OF_SINGLE(/)
#undef BR_RESULT
#define BR_RESULT(value) (value)
BR_OF_SINGLE(<)
BR_OF_SINGLE(>)
BR_OF_SINGLE(<=)
BR_OF_SINGLE(>=)
BR_OF_SINGLE(==)
BR_OF_SINGLE(!=)
#undef BR_RESULT
#undef BR_OF_SINGLE

template <class V>
BR_HD inline SingleOf<V> operator-(const SingleOf<V>& a) {
  return SingleOf<V>(-a.v);
}
template <class V>
BR_HD inline SingleOf<V>& operator+=(SingleOf<V>& a, const SingleOf<V>& b) {
  a.v += b.v;
  return a;
}
template <class V>
BR_HD inline SingleOf<V> max(const SingleOf<V>& a, const SingleOf<V>& b) {
  return SingleOf<V>(a.v > b.v ? a.v : b.v);
}
template <class V>
BR_HD inline SingleOf<V> min(const SingleOf<V>& a, const SingleOf<V>& b) {
  return SingleOf<V>(a.v < b.v ? a.v : b.v);
}
template <class Truth, class V>
BR_HD inline SingleOf<V> select(const Truth& condition, const SingleOf<V>& yes,
                                const SingleOf<V>& no) {
  return SingleOf<V>(condition ? yes.v : no.v);
}
BR_HD inline Single sqrt(const Single& a) {
  return Single(::sqrtf(a.v));
}
BR_HD inline Single abs(const Single& a) {
  return Single(::fabsf(a.v));
}

template <class V>
inline constexpr Index width_of<SingleOf<V>> = static_cast<Index>(sizeof(V) / sizeof(float));
template <>
struct TypesOf<Single> {
  using Bits = std::uint32_t;
};

/// Bits read as integers with a sign, as numbers: to the nearest.
template <class R, class Bits>
BR_HD inline R signed_value(const Bits& bits) {
  if constexpr (width_of<R> == 1) {
    return R(static_cast<float>(static_cast<std::int32_t>(bits)));
  } else {
    return R(__builtin_convertvector(typename TypesOf<R>::Signed(bits), decltype(R::v)));
  }
}

/// Numbers in double beside those of R: what is subtracted before it is rounded.
template <class R>
struct WideOf {
  using type = R;
};
template <>
struct WideOf<Single> {
  using type = double;
};
template <class R>
using Wide = typename WideOf<R>::type;
/// Numbers in double that stand for as many items as R, in parts: what a kernel that computes in
/// single precision reads its arrays by.
template <class R>
struct PartsOf {
  using type = double;
  static constexpr Index count = 1;
};
template <class R>
using PartOf = typename PartsOf<R>::type;
BR_HD inline Single narrowed(double wide) {
  return Single(static_cast<float>(wide));
}
BR_HD inline double widened(const Single& number) {
  return static_cast<double>(number.v);
}

/// A row of four numbers.
BR_HD inline void write_fours(const Single (&numbers)[4], float* to) {
#if defined(__CUDA_ARCH__)
  *reinterpret_cast<float4*>(to) =
      make_float4(numbers[0].v, numbers[1].v, numbers[2].v, numbers[3].v);
#else
  for (int k = 0; k < 4; ++k) to[k] = numbers[k].v;
#endif
}

#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
inline constexpr int single_bytes = static_cast<int>(sizeof(WidestPack));
using SinglePack = SingleOf<float __attribute__((vector_size(single_bytes)))>;
using SingleMask = decltype(SinglePack{} < SinglePack{});

/// A pack of singles in double: its first and its second half.
struct TwoPacks {
  WidestPack half[2];
};
inline TwoPacks operator+(const TwoPacks& a, const TwoPacks& b) {
  return {{a.half[0] + b.half[0], a.half[1] + b.half[1]}};
}
inline TwoPacks operator-(const TwoPacks& a, const TwoPacks& b) {
  return {{a.half[0] - b.half[0], a.half[1] - b.half[1]}};
}
inline TwoPacks operator*(const TwoPacks& a, const TwoPacks& b) {
  return {{a.half[0] * b.half[0], a.half[1] * b.half[1]}};
}
template <>
struct WideOf<SinglePack> {
  using type = TwoPacks;
};
template <>
struct PartsOf<SinglePack> {
  using type = WidestPack;
  static constexpr Index count = 2;
};
template <>
struct TypesOf<SinglePack> {
  using Bits = std::uint32_t __attribute__((vector_size(single_bytes)));
  using Signed = std::int32_t __attribute__((vector_size(single_bytes)));
};
#if defined(__AVX512F__)
/// In each lane of four numbers: number j, then number 4 + j, and so on, of rows 0 to 3 in
/// quads[j], of rows 4 to 7 in quads[4 + j].
inline void interleave(const __m512 (&r)[8], __m512 (&quads)[8]) {
  __m512 pairs[8];
  for (int k = 0; k < 8; k += 2) {
    pairs[k] = _mm512_unpacklo_ps(r[k], r[k + 1]);
    pairs[k + 1] = _mm512_unpackhi_ps(r[k], r[k + 1]);
  }
  for (int k = 0; k < 8; k += 4)
    for (int j = 0; j < 2; ++j) {
      quads[k + 2 * j] = _mm512_shuffle_ps(pairs[k + j], pairs[k + 2 + j], 0x44);
      quads[k + 2 * j + 1] = _mm512_shuffle_ps(pairs[k + j], pairs[k + 2 + j], 0xee);
    }
}
/// Number k of rows 0, 1, ... of eight numbers becomes column k.
inline void columns_of(const __m256 (&rows)[16], SinglePack (&columns)[8]) {
  __m512 r[8], quads[8];
  for (int k = 0; k < 8; ++k)  // rows k and k + 8
    r[k] = _mm512_insertf32x8(_mm512_castps256_ps512(rows[k]), rows[k + 8], 1);
  interleave(r, quads);
  // quads[j]: numbers j, then 4 + j, of rows 0 to 3, then of rows 8 to 11; quads[4 + j] of the rest
  const __m512i low = _mm512_setr_epi32(0, 1, 2, 3, 16, 17, 18, 19, 8, 9, 10, 11, 24, 25, 26, 27);
  const __m512i high =
      _mm512_setr_epi32(4, 5, 6, 7, 20, 21, 22, 23, 12, 13, 14, 15, 28, 29, 30, 31);
  for (int j = 0; j < 4; ++j) {
    columns[j] = SinglePack(_mm512_permutex2var_ps(quads[j], low, quads[4 + j]));
    columns[4 + j] = SinglePack(_mm512_permutex2var_ps(quads[j], high, quads[4 + j]));
  }
}
/// Rows of nine numbers each, from columns; to[stride k]: row k.
template <int stride>
inline void write_rows(const SinglePack (&columns)[9], float* to) {
  __m512 r[8], quads[8];
  for (int k = 0; k < 8; ++k) r[k] = columns[k].v;
  interleave(r, quads);
  const __m512i front = _mm512_setr_epi32(0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23);
  const __m512i back =
      _mm512_setr_epi32(8, 9, 10, 11, 24, 25, 26, 27, 12, 13, 14, 15, 28, 29, 30, 31);
  for (int j = 0; j < 4; ++j) {
    const __m512 low = _mm512_permutex2var_ps(quads[j], front, quads[4 + j]);
    const __m512 high = _mm512_permutex2var_ps(quads[j], back, quads[4 + j]);
    _mm256_storeu_ps(to + stride * j, _mm512_castps512_ps256(low));
    _mm256_storeu_ps(to + stride * (4 + j), _mm512_extractf32x8_ps(low, 1));
    _mm256_storeu_ps(to + stride * (8 + j), _mm512_castps512_ps256(high));
    _mm256_storeu_ps(to + stride * (12 + j), _mm512_extractf32x8_ps(high, 1));
  }
  for (int k = 0; k < 16; ++k) to[stride * k + 8] = columns[8].v[k];
}
/// Rows of four numbers each, from columns.
inline void write_fours(const SinglePack (&columns)[4], float* to) {
  const __m512 low01 = _mm512_unpacklo_ps(columns[0].v, columns[1].v),
               high01 = _mm512_unpackhi_ps(columns[0].v, columns[1].v),
               low23 = _mm512_unpacklo_ps(columns[2].v, columns[3].v),
               high23 = _mm512_unpackhi_ps(columns[2].v, columns[3].v);
  // each of rows j, 4 + j, 8 + j, 12 + j
  const __m512 rows[4] = {
      _mm512_shuffle_ps(low01, low23, 0x44), _mm512_shuffle_ps(low01, low23, 0xee),
      _mm512_shuffle_ps(high01, high23, 0x44), _mm512_shuffle_ps(high01, high23, 0xee)};
  for (int j = 0; j < 4; ++j) {
    _mm_storeu_ps(to + 4 * j, _mm512_castps512_ps128(rows[j]));
    _mm_storeu_ps(to + 4 * (4 + j), _mm512_extractf32x4_ps(rows[j], 1));
    _mm_storeu_ps(to + 4 * (8 + j), _mm512_extractf32x4_ps(rows[j], 2));
    _mm_storeu_ps(to + 4 * (12 + j), _mm512_extractf32x4_ps(rows[j], 3));
  }
}
inline SinglePack sqrt(const SinglePack& a) {
  return SinglePack(_mm512_sqrt_ps(a.v));
}
inline SinglePack abs(const SinglePack& a) {
  return SinglePack(_mm512_abs_ps(a.v));
}
inline bool any(const SingleMask& condition) {
  return _mm512_movepi32_mask(__m512i(condition)) != 0;
}
inline SinglePack narrowed(const TwoPacks& wide) {
  return SinglePack(
      _mm512_insertf32x8(_mm512_castps256_ps512(rounded(wide.half[0])), rounded(wide.half[1]), 1));
}
inline TwoPacks widened(const SinglePack& number) {
  return {{_mm512_cvtps_pd(_mm512_castps512_ps256(number.v)),
           _mm512_cvtps_pd(_mm512_extractf32x8_ps(number.v, 1))}};
}
#else
/// Number k of rows 0, 1, ... of eight numbers becomes column k.
inline void columns_of(const __m256 (&rows)[8], SinglePack (&columns)[8]) {
  __m256 r[8];
  for (int k = 0; k < 8; ++k) r[k] = rows[k];
  transpose(r);
  for (int k = 0; k < 8; ++k) columns[k] = SinglePack(r[k]);
}
/// Rows of nine numbers each, from columns; to[stride k]: row k.
template <int stride>
inline void write_rows(const SinglePack (&columns)[9], float* to) {
  __m256 r[8];
  for (int k = 0; k < 8; ++k) r[k] = columns[k].v;
  transpose(r);
  for (int k = 0; k < 8; ++k) {
    _mm256_storeu_ps(to + stride * k, r[k]);
    to[stride * k + 8] = columns[8].v[k];
  }
}
/// Rows of four numbers each, from columns.
inline void write_fours(const SinglePack (&columns)[4], float* to) {
  const __m256 low01 = _mm256_unpacklo_ps(columns[0].v, columns[1].v),
               high01 = _mm256_unpackhi_ps(columns[0].v, columns[1].v),
               low23 = _mm256_unpacklo_ps(columns[2].v, columns[3].v),
               high23 = _mm256_unpackhi_ps(columns[2].v, columns[3].v);
  const __m256 rows[4] = {
      _mm256_shuffle_ps(low01, low23, 0x44), _mm256_shuffle_ps(low01, low23, 0xee),
      _mm256_shuffle_ps(high01, high23, 0x44), _mm256_shuffle_ps(high01, high23, 0xee)};
  for (int j = 0; j < 4; ++j) {  // rows j and 4 + j
    _mm_storeu_ps(to + 4 * j, _mm256_castps256_ps128(rows[j]));
    _mm_storeu_ps(to + 4 * (4 + j), _mm256_extractf128_ps(rows[j], 1));
  }
}
inline SinglePack sqrt(const SinglePack& a) {
  return SinglePack(_mm256_sqrt_ps(a.v));
}
inline SinglePack abs(const SinglePack& a) {
  return SinglePack(_mm256_andnot_ps(_mm256_set1_ps(-0.0F), a.v));
}
inline bool any(const SingleMask& condition) {
  return _mm256_movemask_ps(__m256(condition)) != 0;
}
inline SinglePack narrowed(const TwoPacks& wide) {
  return SinglePack(_mm256_insertf128_ps(_mm256_castps128_ps256(rounded(wide.half[0])),
                                         rounded(wide.half[1]), 1));
}
inline TwoPacks widened(const SinglePack& number) {
  return {{_mm256_cvtps_pd(_mm256_castps256_ps128(number.v)),
           _mm256_cvtps_pd(_mm256_extractf128_ps(number.v, 1))}};
}
#endif
#endif

/// One of the parts of numbers in double.
template <class W, class Parts>
BR_HD inline W part_of(const Parts& parts, [[maybe_unused]] Index which) {
  if constexpr (width_of<W> == 1)
    return parts;
  else
    return parts.half[which];
}
/// Records in double that stand for one of R's numbers.
template <class Record, Index count>
struct RecordParts {
  Record part[count];
};
/// @param make  make(p) gives part p
template <class R, class Make>
BR_HD inline auto parts_by(const Make& make) {
  using Record = decltype(make(Index{0}));
  if constexpr (PartsOf<R>::count == 1)
    return RecordParts<Record, 1>{{make(0)}};
  else
    return RecordParts<Record, 2>{{make(0), make(1)}};
}
/// A record of numbers, each rounded to the nearest, from parts in double.
template <class R, template <class> class Record>
BR_HD inline Record<R> narrowed_record(const Record<PartOf<R>> (&parts)[PartsOf<R>::count]) {
  using W = PartOf<R>;
  constexpr int count = sizeof(Record<double>) / sizeof(double);
  static_assert(sizeof(Record<R>) == count * sizeof(R));
  Record<R> record;
  if constexpr (width_of<R> == 1) {
    W wide[count];
    __builtin_memcpy(wide, parts, sizeof wide);
    R numbers[count];
    for (int k = 0; k < count; ++k) numbers[k] = narrowed(wide[k]);
    __builtin_memcpy(&record, numbers, sizeof record);
  } else {
    const auto* const first = reinterpret_cast<const W*>(&parts[0]);
    const auto* const second = reinterpret_cast<const W*>(&parts[1]);
    auto* const numbers = reinterpret_cast<R*>(&record);
    for (int k = 0; k < count; ++k) numbers[k] = narrowed(Wide<R>{{first[k], second[k]}});
  }
  return record;
}

/// A record of doubles in floats, each rounded to the nearest.
template <template <class> class Record>
Record<float> in_floats(const Record<double>& record) {
  constexpr int count = sizeof(Record<double>) / sizeof(double);
  static_assert(sizeof(Record<float>) == count * sizeof(float));
  double wide[count];
  __builtin_memcpy(wide, &record, sizeof wide);
  float numbers[count];
  for (int k = 0; k < count; ++k) numbers[k] = static_cast<float>(wide[k]);
  Record<float> rounded;
  __builtin_memcpy(&rounded, numbers, sizeof rounded);
  return rounded;
}

/// A function of double for each item.
template <class R, class Function>
BR_HD inline R by_items(const R& numbers, const Function& function) {
  if constexpr (width_of<R> == 1) {
    return narrowed(function(widened(numbers)));
  } else {
    R results;
    for (Index k = 0; k < width_of<R>; ++k)
      results.v[k] = static_cast<float>(function(static_cast<double>(numbers.v[k])));
    return results;
  }
}

/// The type of a law's constants beside numbers of type R.
template <class R>
using ConstantOf = std::conditional_t<is_single<R>, float, double>;

/// The type in memory of numbers that a run computes as `Number`: double, or float of float and
/// Single.
template <class Number>
using StoredAs = std::conditional_t<std::is_same_v<Number, double>, double, float>;

/// The type of numbers in a kernel whose links are stored as `Number`; packs of it on the host.
template <class Number>
using ComputedIn = std::conditional_t<std::is_same_v<Number, Single>, Single, double>;

}  // namespace breccia
