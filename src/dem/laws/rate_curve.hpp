#pragma once
// Tensile strength of concrete over strain rate.

#include "math/elementary.hpp"
#include "math/single.hpp"

namespace breccia::dem {

/// Tensile strength over strain rate e, dynamic over static (DIF):
///
///   DIF = (e / e_s)^delta                          up to the bend e_1, e_s = 1e-6/s
///   DIF = (e_1 / e_s)^delta (e / e_1)^(1/3)        beyond, until 160/s, as far as tests go
///
/// Malvar and Ross 1998: delta = 1 / (1 + 8 f_c / 10 MPa), e_1 = 1/s. fib Model Code
/// 2010, 5.1.11.2: delta = 0.018, e_1 = 10/s.
struct RateCurve {
  double exponent;  ///< delta; 0: strength does not depend on rate  [-]
  double bend;      ///< ln(e_1 / e_s)  [-]
  double speed;  ///< of the wave in a bar over the crossings that count: D / time constant  [m/s]

  template <class R>
  BR_HD R factor(const R& rate) const {
    if constexpr (is_single<R>)
      return by_items(rate, [this](double of) { return factor(of); });
    else
      return factor_of(rate);
  }

 private:
  template <class R>
  BR_HD R factor_of(const R& rate) const {
    const R held = min(max(rate, constant<R>(1e-6)), constant<R>(160.0));
    const R x = logarithm<R>(1e6 * held);
    const R beyond = max(x - bend, constant<R>(0.0));
    return exponential<R>(exponent * (x - beyond) + beyond * (1.0 / 3.0));
  }
};

}  // namespace breccia::dem
