#pragma once
// Exponential, logarithm, arc tangent and power from + - * / and square roots: equal bits on every
// host, in packs, and on every device, which the functions of a system's library do not have.

#include <cmath>

#include "math/two.hpp"

namespace breccia {

namespace detail {
template <class To, class From>
BR_HD inline To bits_as(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  if constexpr (is_two<To>) {
    return {bits_as<decltype(To::one)>(from.one), bits_as<decltype(To::other)>(from.other)};
  } else {
    To to;
    __builtin_memcpy(&to, &from, sizeof to);
    return to;
  }
}
/// Sum of c[k] x^k, even and odd k side by side: half the time of waiting for results.
template <class R, int count>
BR_HD inline R polynomial(const double (&c)[count], const R& x) {
  constexpr int last_even = (count - 1) / 2 * 2, last_odd = (count - 2) / 2 * 2 + 1;
  const R square = x * x;
  R even = constant<R>(c[last_even]), odd = constant<R>(c[last_odd]);
  BR_UNROLL for (int k = last_even - 2; k >= 0; k -= 2) even = even * square + c[k];
  BR_UNROLL for (int k = last_odd - 2; k > 0; k -= 2) odd = odd * square + c[k];
  return even + x * odd;
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
  constexpr double series[] = {1.0,
                               1.0,
                               0.5,
                               1.0 / 6,
                               1.0 / 24,
                               1.0 / 120,
                               1.0 / 720,
                               1.0 / 5040,
                               1.0 / 40320,
                               1.0 / 362880,
                               1.0 / 3628800,
                               1.0 / 39916800,
                               1.0 / 479001600};
  const R p = detail::polynomial(series, r);
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
  constexpr double series[] = {1.0,        1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0,
                               1.0 / 9.0,  1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0,
                               1.0 / 17.0, 1.0 / 19.0, 1.0 / 21.0};
  const R sum = detail::polynomial(series, square);
  return exponent * 0.693147180559945309 + 2.0 * t * sum;
}

/// ln(1 + x) - x, to rounding also where x is small; no number for x <= -1.
///
/// x^2 (-1/2 + x/3 - x^2/4 ...): 0.05^13/15 < 1e-16, as 0.001^6/8
template <class R>
BR_HD inline R log_less_linear(const R& x) {
  constexpr double terms[] = {-1.0 / 14, 1.0 / 13, -1.0 / 12, 1.0 / 11, -1.0 / 10,
                              1.0 / 9,   -1.0 / 8, 1.0 / 7,   -1.0 / 6, 1.0 / 5,
                              -1.0 / 4,  1.0 / 3,  -1.0 / 2};
  constexpr int first_of_small = 7, count = 13;
  const auto near = abs(x) < 0.05, small = abs(x) < 1e-3;
  R series = constant<R>(0.0);
  if (any(!small)) {
    for (int k = 0; k < first_of_small; ++k) series = series * x + terms[k];
    series = select(small, constant<R>(0.0), series);
  }
  for (int k = first_of_small; k < count; ++k) series = series * x + terms[k];
  const R of_near = x * x * series;
  if (!any(!near)) return of_near;
  const R of_far = select(x > -1.0, logarithm<R>(1.0 + x) - x, constant<R>(NAN));
  return select(near, of_near, of_far);
}

/// Angle in [0, pi/4] whose tangent is x in [0, 1]. Error below 1e-15.
///
/// x times a polynomial in x^2: that through the 19 Chebyshev points of [0, 1].
template <class R>
BR_HD inline R arc_tangent(const R& x) {
  constexpr double through_points[] = {
      0.9999999999999998,    -0.333333333333188,      0.19999999998244405,  -0.14285714201153485,
      0.11111108947215684,   -0.09090875100099982,    0.07691950418796795,  -0.06664007607654046,
      0.05867776001706719,   -0.052025829246698206,   0.045668724719449945, -0.03852606834610674,
      0.02992405293802711,   -0.02033087003302746,    0.011430023675054508, -0.0050003664537326496,
      0.0015739493241755762, -0.00031420077366807334, 2.969635660165779e-05};
  return x * detail::polynomial(through_points, x * x);
}

/// x^p, 0 < x <= 1, p >= 0.
template <class R>
BR_HD inline R power_of(const R& x, double p) {
  return exponential<R>(p * logarithm(x));
}

}  // namespace breccia
