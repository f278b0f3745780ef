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

/// Rounded to single precision.
template <class R>
BR_HD inline void store_rounded(const View<float>& array, Index first, const R& value) {
  if constexpr (width_of<R> == 1) {
    array[first] = static_cast<float>(value);
  } else {
    BR_ASSERT(first >= 0 && first + width_of<R> <= array.size);
    const auto floats = rounded(value);
    __builtin_memcpy(array.data + first, &floats, sizeof floats);
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

/// array[i] for each index of a pack.
BR_HD inline double gather(const View<const double>& array, Indices<double> i) {
  return array[i.at];
}
BR_HD inline Vec3 gather(const View<const Vec3>& array, Indices<double> i) {
  return array[i.at];
}

#if !defined(__CUDACC__) && defined(__AVX512F__)

template <>
struct Indices<Pack8> {
  __m256i at;
};
template <>
inline Indices<Pack8> load_indices<Pack8>(const View<const Index>& array, Index first) {
  return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(array.data + first))};
}
inline Pack8 gather(const View<const double>& array, Indices<Pack8> i) {
  return _mm512_i32gather_pd(i.at, array.data, 8);
}
inline Vec3Of<Pack8> gather(const View<const Vec3>& array, Indices<Pack8> i) {
  const auto* components = reinterpret_cast<const double*>(array.data);
  const __m256i at = _mm256_add_epi32(_mm256_add_epi32(i.at, i.at), i.at);
  return {_mm512_i32gather_pd(at, components, 8), _mm512_i32gather_pd(at, components + 1, 8),
          _mm512_i32gather_pd(at, components + 2, 8)};
}

#elif !defined(__CUDACC__) && defined(__AVX2__)

template <>
struct Indices<Pack4> {
  __m128i at;
};
template <>
inline Indices<Pack4> load_indices<Pack4>(const View<const Index>& array, Index first) {
  return {_mm_loadu_si128(reinterpret_cast<const __m128i*>(array.data + first))};
}
inline Pack4 gather(const View<const double>& array, Indices<Pack4> i) {
  return _mm256_i32gather_pd(array.data, i.at, 8);
}
inline Vec3Of<Pack4> gather(const View<const Vec3>& array, Indices<Pack4> i) {
  const auto* components = reinterpret_cast<const double*>(array.data);
  const __m128i at = _mm_add_epi32(_mm_add_epi32(i.at, i.at), i.at);
  return {_mm256_i32gather_pd(components, at, 8), _mm256_i32gather_pd(components + 1, at, 8),
          _mm256_i32gather_pd(components + 2, at, 8)};
}

#endif

}  // namespace breccia
