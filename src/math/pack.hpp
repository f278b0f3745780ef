#pragma once
// Packs of doubles: one kernel text runs on one item (R = double) or on several side by side
// (R = Pack<W>), with the same arithmetic per item and so the same bits.
//
// A pack is the compiler's own vector type; only root and the masks need the processor's names,
// chosen by what the including file is compiled for (see dem/lanes/kernel_lanes.cpp).

#include <cmath>

#include "exec/types.hpp"

#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
#include <immintrin.h>
#endif

namespace breccia {

BR_HD inline double sqrt(double a) {
  return ::sqrt(a);
}
BR_HD inline double abs(double a) {
  return fabs(a);
}
BR_HD inline double max(double a, double b) {
  return a > b ? a : b;
}
BR_HD inline double min(double a, double b) {
  return a < b ? a : b;
}
BR_HD inline double select(bool condition, double yes, double no) {
  return condition ? yes : no;
}
BR_HD inline bool any(bool condition) {
  return condition;
}

/// Six sums that grow together.
struct SixSums {
#if defined(__CUDACC__)
  double sum[6] = {};
  template <class Number>
  BR_HD void add(const Number* numbers) {
    for (int k = 0; k < 6; ++k) sum[k] += numbers[k];
  }
  BR_HD double operator[](int k) const {
    return sum[k];
  }
#else
#if defined(__clang__)  // reads the alignment only here
  typedef double Two __attribute__((vector_size(16), aligned(8), may_alias));
#else
  using Two = double __attribute__((vector_size(16), aligned(8), may_alias));
#endif
  Two sum[3] = {};
  void add(const double* numbers) {
    const auto* twos = reinterpret_cast<const Two*>(numbers);
    for (int k = 0; k < 3; ++k) sum[k] += twos[k];
  }
  void add(const float* numbers) {
    for (int k = 0; k < 3; ++k) sum[k] += Two{numbers[2 * k], numbers[2 * k + 1]};
  }
  double operator[](int k) const {
    return sum[k / 2][k % 2];
  }
#endif
};
/// Eight sums side by side, in single precision.
struct EightFloatSums {
#if defined(__CUDACC__)
  float sum[8] = {};
  BR_HD void add(const float* numbers) {
    for (int k = 0; k < 8; ++k) sum[k] += numbers[k];
  }
  BR_HD void add(float factor, const float* numbers) {
    for (int k = 0; k < 8; ++k) sum[k] += factor * numbers[k];
  }
  BR_HD float operator[](int k) const {
    return sum[k];
  }
#else
#if defined(__clang__)
  typedef float Eight __attribute__((vector_size(32), aligned(4), may_alias));
#else
  using Eight = float __attribute__((vector_size(32), aligned(4), may_alias));
#endif
  Eight sum{};
  void add(const float* numbers) {
    sum += *reinterpret_cast<const Eight*>(numbers);
  }
  void add(float factor, const float* numbers) {
    sum += factor * *reinterpret_cast<const Eight*>(numbers);
  }
  float operator[](int k) const {
    return sum[k];
  }
#endif
};

#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
/// Transposes eight rows of eight numbers in single precision.
inline void transpose(__m256 (&r)[8]) {
  __m256 pairs[8], quads[8];
  for (int k = 0; k < 8; k += 2) {
    pairs[k] = _mm256_unpacklo_ps(r[k], r[k + 1]);
    pairs[k + 1] = _mm256_unpackhi_ps(r[k], r[k + 1]);
  }
  for (int k = 0; k < 8; k += 4)
    for (int j = 0; j < 2; ++j) {
      quads[k + 2 * j] = _mm256_shuffle_ps(pairs[k + j], pairs[k + 2 + j], 0x44);
      quads[k + 2 * j + 1] = _mm256_shuffle_ps(pairs[k + j], pairs[k + 2 + j], 0xee);
    }
  for (int k = 0; k < 4; ++k) {
    r[k] = _mm256_permute2f128_ps(quads[k], quads[k + 4], 0x20);
    r[k + 4] = _mm256_permute2f128_ps(quads[k], quads[k + 4], 0x31);
  }
}
#endif
#if !defined(__CUDACC__) && defined(__AVX512F__)

using Pack8 = double __attribute__((vector_size(64)));
using Mask8 = decltype(Pack8{} < Pack8{});

inline Pack8 sqrt(Pack8 a) {
  return _mm512_sqrt_pd(a);
}
inline Pack8 abs(Pack8 a) {
  return _mm512_abs_pd(a);
}
inline Pack8 max(Pack8 a, Pack8 b) {
  return a > b ? a : b;
}
inline Pack8 min(Pack8 a, Pack8 b) {
  return a < b ? a : b;
}
inline Pack8 select(Mask8 condition, Pack8 yes, Pack8 no) {
  return condition ? yes : no;
}
inline bool any(Mask8 condition) {
  return _mm512_movepi64_mask(__m512i(condition)) != 0;
}
inline __m256 rounded(Pack8 a) {
  return _mm512_cvtpd_ps(a);
}
/// Number i of pack k becomes number k of pack i.
inline void transpose(Pack8 (&r)[8]) {
  __m512d pairs[8], quads[8];
  for (int k = 0; k < 8; k += 2) {
    pairs[k] = _mm512_unpacklo_pd(r[k], r[k + 1]);
    pairs[k + 1] = _mm512_unpackhi_pd(r[k], r[k + 1]);
  }
  for (int k = 0; k < 8; k += 4)
    for (int j = 0; j < 2; ++j) {
      quads[k + j] = _mm512_shuffle_f64x2(pairs[k + j], pairs[k + 2 + j], 0x88);
      quads[k + 2 + j] = _mm512_shuffle_f64x2(pairs[k + j], pairs[k + 2 + j], 0xdd);
    }
  for (int j = 0; j < 2; ++j)
    for (int half = 0; half < 2; ++half) {
      const __m512d low = quads[2 * half + j], high = quads[4 + 2 * half + j];
      r[2 * half + j] = _mm512_shuffle_f64x2(low, high, 0x88);
      r[4 + 2 * half + j] = _mm512_shuffle_f64x2(low, high, 0xdd);
    }
}
using WidestPack = Pack8;

#elif !defined(__CUDACC__) && defined(__AVX2__)

using Pack4 = double __attribute__((vector_size(32)));
using Mask4 = decltype(Pack4{} < Pack4{});

inline Pack4 sqrt(Pack4 a) {
  return _mm256_sqrt_pd(a);
}
inline Pack4 abs(Pack4 a) {
  return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a);
}
inline Pack4 max(Pack4 a, Pack4 b) {
  return a > b ? a : b;
}
inline Pack4 min(Pack4 a, Pack4 b) {
  return a < b ? a : b;
}
inline Pack4 select(Mask4 condition, Pack4 yes, Pack4 no) {
  return condition ? yes : no;
}
inline bool any(Mask4 condition) {
  return _mm256_movemask_pd(__m256d(condition)) != 0;
}
inline __m128 rounded(Pack4 a) {
  return _mm256_cvtpd_ps(a);
}
/// Number i of pack k becomes number k of pack i.
inline void transpose(Pack4 (&r)[4]) {
  const __m256d low01 = _mm256_unpacklo_pd(r[0], r[1]), high01 = _mm256_unpackhi_pd(r[0], r[1]);
  const __m256d low23 = _mm256_unpacklo_pd(r[2], r[3]), high23 = _mm256_unpackhi_pd(r[2], r[3]);
  r[0] = _mm256_permute2f128_pd(low01, low23, 0x20);
  r[1] = _mm256_permute2f128_pd(high01, high23, 0x20);
  r[2] = _mm256_permute2f128_pd(low01, low23, 0x31);
  r[3] = _mm256_permute2f128_pd(high01, high23, 0x31);
}
using WidestPack = Pack4;

#endif

/// For a number type: its single-precision counterpart, and an integer type of equal width.
template <class R>
struct TypesOf;
template <>
struct TypesOf<double> {
  using Single = float;
  using Bits = std::uint64_t;
};
#if !defined(__CUDACC__) && defined(__AVX512F__)
template <>
struct TypesOf<Pack8> {
  using Single = float __attribute__((vector_size(32)));
  using Bits = std::uint64_t __attribute__((vector_size(64)));
};
#elif !defined(__CUDACC__) && defined(__AVX2__)
template <>
struct TypesOf<Pack4> {
  using Single = float __attribute__((vector_size(16)));
  using Bits = std::uint64_t __attribute__((vector_size(32)));
};
#endif

/// How many items a number of type R stands for.
template <class R>
inline constexpr Index width_of = static_cast<Index>(sizeof(R) / sizeof(double));

/// A constant, equal in every item of a pack.
template <class R>
BR_HD inline R constant(double value) {
  return R{} + value;
}

}  // namespace breccia
