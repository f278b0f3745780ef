#pragma once
// Packs of doubles: one kernel text runs on one item (R = double) or on several side by side
// (R = Pack<W>), with the same arithmetic per item and so the same bits.
//
// A pack is the compiler's own vector type; only root and the masks need the processor's names,
// chosen by what the including file is compiled for (see dem/link_lanes.cpp).

#include <cmath>

#include "exec/types.hpp"

#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
#include <immintrin.h>
#endif

namespace breccia {

BR_HD inline double root(double a) {
  return sqrt(a);
}
BR_HD inline double absolute(double a) {
  return fabs(a);
}
BR_HD inline double larger(double a, double b) {
  return a > b ? a : b;
}
BR_HD inline double smaller(double a, double b) {
  return a < b ? a : b;
}
BR_HD inline double choose(bool condition, double yes, double no) {
  return condition ? yes : no;
}
BR_HD inline bool any(bool condition) {
  return condition;
}
/// Truth of two statements together, item by item.
BR_HD inline bool both(bool a, bool b) {
  return a && b;
}
BR_HD inline bool either(bool a, bool b) {
  return a || b;
}
BR_HD inline bool opposite(bool a) {
  return !a;
}

#if !defined(__CUDACC__) && defined(__AVX512F__)

using Pack8 = double __attribute__((vector_size(64)));
using Mask8 = decltype(Pack8{} < Pack8{});

inline Pack8 root(Pack8 a) {
  return _mm512_sqrt_pd(a);
}
inline Pack8 absolute(Pack8 a) {
  return _mm512_abs_pd(a);
}
inline Pack8 larger(Pack8 a, Pack8 b) {
  return a > b ? a : b;
}
inline Pack8 smaller(Pack8 a, Pack8 b) {
  return a < b ? a : b;
}
inline Pack8 choose(Mask8 condition, Pack8 yes, Pack8 no) {
  return condition ? yes : no;
}
inline bool any(Mask8 condition) {
  return _mm512_movepi64_mask(__m512i(condition)) != 0;
}
inline Mask8 both(Mask8 a, Mask8 b) {
  return a & b;
}
inline Mask8 either(Mask8 a, Mask8 b) {
  return a | b;
}
inline Mask8 opposite(Mask8 a) {
  return ~a;
}
inline __m256 rounded(Pack8 a) {
  return _mm512_cvtpd_ps(a);
}
using WidestPack = Pack8;

#elif !defined(__CUDACC__) && defined(__AVX2__)

using Pack4 = double __attribute__((vector_size(32)));
using Mask4 = decltype(Pack4{} < Pack4{});

inline Pack4 root(Pack4 a) {
  return _mm256_sqrt_pd(a);
}
inline Pack4 absolute(Pack4 a) {
  return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a);
}
inline Pack4 larger(Pack4 a, Pack4 b) {
  return a > b ? a : b;
}
inline Pack4 smaller(Pack4 a, Pack4 b) {
  return a < b ? a : b;
}
inline Pack4 choose(Mask4 condition, Pack4 yes, Pack4 no) {
  return condition ? yes : no;
}
inline bool any(Mask4 condition) {
  return _mm256_movemask_pd(__m256d(condition)) != 0;
}
inline Mask4 both(Mask4 a, Mask4 b) {
  return a & b;
}
inline Mask4 either(Mask4 a, Mask4 b) {
  return a | b;
}
inline Mask4 opposite(Mask4 a) {
  return ~a;
}
inline __m128 rounded(Pack4 a) {
  return _mm256_cvtpd_ps(a);
}
using WidestPack = Pack4;

#endif

/// How many items a number of type R stands for.
template <class R>
inline constexpr Index width_of = static_cast<Index>(sizeof(R) / sizeof(double));

/// The same constant for every item of a number.
template <class R>
BR_HD inline R constant(double value) {
  return R{} + value;
}

}  // namespace breccia
