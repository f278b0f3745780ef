#pragma once
// Exponential, logarithm, arc tangent and power from + - * / and square roots: equal bits on every
// host, in packs, and on every device, which the functions of a system's library do not have.

#include "math/pack.hpp"

namespace breccia {

namespace detail {
template <class To, class From>
BR_HD inline To bits_as(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  __builtin_memcpy(&to, &from, sizeof to);
  return to;
}
}  // namespace detail

/// e^x; x is held within [-700, 700]. Relative error below 1e-15.
///
/// x = n ln 2 + r, |r| <= ln 2 / 2; e^r by its series to degree 12, 2^n by its exponent.
template <class R>
BR_HD inline R exponential(const R& x) {
  using Bits = typename TypesOf<R>::Bits;
  const R held = min(max(x, constant<R>(-700.0)), constant<R>(700.0));
  const double rounder = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer
  const R shifted = 1.4426950408889634 * held + rounder;
  const R n = shifted - rounder;
  const R r = (held - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;
  constexpr double series[] = {1.0 / 479001600,
                               1.0 / 39916800,
                               1.0 / 3628800,
                               1.0 / 362880,
                               1.0 / 40320,
                               1.0 / 5040,
                               1.0 / 720,
                               1.0 / 120,
                               1.0 / 24,
                               1.0 / 6,
                               0.5,
                               1.0,
                               1.0};
  R p = constant<R>(series[0]);
  BR_UNROLL for (int k = 1; k < 13; ++k) p = p * r + series[k];
  const Bits power = (detail::bits_as<Bits>(shifted) + 1023U) << 52U;
  return p * detail::bits_as<R>(power);
}

/// ln x of a normal x > 0. Error below 1e-15 of 1 or of the logarithm.
///
/// x = 2^e m, m in [1, 2), halved beyond 1.4142; ln m = 2 atanh((m - 1) / (m + 1)) by its series.
template <class R>
BR_HD inline R logarithm(const R& x) {
  using Bits = typename TypesOf<R>::Bits;
  const Bits bits = detail::bits_as<Bits>(x);
  const R e = detail::bits_as<R>((bits >> 52U) | 0x4330000000000000U) - 4503599627371519.0;
  const R m = detail::bits_as<R>((bits & 0xfffffffffffffU) | 0x3ff0000000000000U);
  const auto large = m > 1.4142135623730951;
  const R mantissa = select(large, 0.5 * m, m), exponent = select(large, e + 1.0, e);
  const R t = (mantissa - 1.0) / (mantissa + 1.0), square = t * t;
  R sum = constant<R>(1.0 / 21.0);
  BR_UNROLL for (int k = 19; k > 0; k -= 2) sum = sum * square + 1.0 / k;
  return exponent * 0.693147180559945309 + 2.0 * t * sum;
}

/// Angle in [0, pi/4] whose tangent is x in [0, 1]. Error below 1e-15.
///
/// Beyond tan(pi/8) the angle is taken from pi/4, then halved: |u| < 0.2, series to u^21.
template <class R>
BR_HD inline R arc_tangent(const R& x) {
  const auto large = x > 0.41421356237309503;
  const R t = select(large, (x - 1.0) / (x + 1.0), x);
  const R u = t / (1.0 + sqrt(1.0 + t * t)), square = u * u;
  R sum = constant<R>(1.0 / 21.0);
  BR_UNROLL for (int k = 19; k > 0; k -= 2) sum = (k % 4 == 3 ? -1.0 / k : 1.0 / k) + sum * square;
  return select(large, constant<R>(0.78539816339744831), constant<R>(0.0)) + 2.0 * u * sum;
}

/// x^p, 0 < x <= 1, p >= 0.
template <class R>
BR_HD inline R power_of(const R& x, double p) {
  return exponential<R>(p * logarithm(x));
}

}  // namespace breccia
