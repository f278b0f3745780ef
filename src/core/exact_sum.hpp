#pragma once
// Sums of doubles that do not depend on the order of their terms, of one term or several at a time.

#include <cmath>
#include <cstdint>

#include "math/pack.hpp"

namespace breccia {

/// A sum of doubles in fixed point, 128 bit with a quantum of 2^-64: each term is rounded once, by
/// itself, so the sum is the same for any order, thread count, rank count and device.
/// Holds |sum| < 2^63 of the unit, to 5e-20. A term that is beyond that, or no number, makes the
/// sum infinite for good, in whatever order it comes.
class ExactSum {
  __extension__ using Quanta = unsigned __int128;
  static constexpr Quanta overflown = static_cast<Quanta>(1) << 127;
  static constexpr double limit = 9223372036854775808.0;  // 2^63

 public:
  ExactSum() = default;
  BR_HD explicit ExactSum(double value) { add(value); }

  BR_HD void add(double value) {
    if (value == 0.0) return;  // most of what most items have spent
    const double scaled_high = value < 0.0 ? -value : value;
    if (!(scaled_high < limit) || quanta_ == overflown) {
      quanta_ = overflown;
      return;
    }
    const double whole = static_cast<double>(static_cast<std::int64_t>(scaled_high));
    const double fraction = (scaled_high - whole) * 18446744073709551616.0;  // 2^64
    Quanta quanta = static_cast<Quanta>(static_cast<std::uint64_t>(whole)) << 64;
    quanta += static_cast<std::uint64_t>(fraction);
    if (value < 0.0)
      quanta_ -= quanta;
    else
      quanta_ += quanta;
  }
  BR_HD void add(const ExactSum& other) {
    const bool lost = quanta_ == overflown || other.quanta_ == overflown;
    quanta_ = lost ? overflown : quanta_ + other.quanta_;
  }

  /// Adds high + middle 2^-32 + low 2^-64.
  BR_HD void add_parts(std::int64_t high, std::int64_t middle, std::int64_t low) {
    if (quanta_ == overflown) return;
    quanta_ += (wide(high) << 64) + (wide(middle) << 32) + wide(low);
  }

  BR_HD double value() const {
    if (quanta_ == overflown) return INFINITY;
    const bool negative = (quanta_ >> 127) != 0;
    const Quanta size = negative ? -quanta_ : quanta_;
    const double high = static_cast<double>(static_cast<std::uint64_t>(size >> 64));
    const double low = static_cast<double>(static_cast<std::uint64_t>(size));
    const double result = high + low / 18446744073709551616.0;
    return negative ? -result : result;
  }

 private:
  BR_HD static Quanta wide(std::int64_t part) { return static_cast<Quanta>(part); }

  Quanta quanta_ = 0;
};

BR_HD inline ExactSum operator+(ExactSum a, const ExactSum& b) {
  a.add(b);
  return a;
}

#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
#if defined(__AVX512F__)
inline Pack8 floor_of(Pack8 a) {
  return _mm512_roundscale_pd(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}
#else
inline Pack4 floor_of(Pack4 a) {
  return _mm256_floor_pd(a);
}
#endif

/// Sums of each place in packs: of fewer than 2^31 packs they add up to the ExactSum of all
/// numbers.
template <class R>
class PackSum {
  using Whole = decltype(R{} < R{});  ///< 64 bit, -1 where it is true
  static constexpr double word = 4294967296.0, most = 2251799813685248.0;  ///< 2^32, 2^51

 public:
  void add(const R& value) {
    if (!any(value != 0.0)) return;  // most of what most items have spent
    const R size = abs(value);
    if (any(!(size < most))) {
      for (Index k = 0; k < width_of<R>; ++k) others_.add(value[k]);
      return;
    }
    const R high = floor_of(size), rest = (size - high) * word;
    const R middle = floor_of(rest), low = floor_of((rest - middle) * word);
    const Whole negative = value < 0.0;
    high_ += signed_as(negative, high);
    middle_ += signed_as(negative, middle);
    low_ += signed_as(negative, low);
  }
  ExactSum sum() const {
    ExactSum all = others_;
    for (Index k = 0; k < width_of<R>; ++k) all.add_parts(high_[k], middle_[k], low_[k]);
    return all;
  }

 private:
  /// The whole number that a number below 2^52 is, by its bits.
  static Whole signed_as(const Whole& negative, const R& number) {
    const R one_less = constant<R>(2.0 * most);  // 2^52, whose last bit is 1
    const Whole whole = Whole(number + one_less) - Whole(one_less);
    return (whole ^ negative) - negative;
  }

  Whole high_{}, middle_{}, low_{};
  ExactSum others_;  ///< of packs with a large number in them
};
#endif

namespace detail {
template <class R>
struct SumFor;
template <>
struct SumFor<double> {
  using Type = ExactSum;
};
#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
template <>
struct SumFor<WidestPack> {
  using Type = PackSum<WidestPack>;
};
#endif
}  // namespace detail

/// The sum of numbers R: of single ones or of packs.
template <class R>
using SumOf = typename detail::SumFor<R>::Type;

}  // namespace breccia
