#pragma once
// Rounding to single precision by chance.
//
// A sum of many small steps must not be rounded to the nearest: a step below half the last bit
// would be lost, every time. Rounded up as often as the upper neighbour is near, sums are right on
// average. Chance is a hash of numbers that every thread, rank and device has alike.

#include "math/elementary.hpp"
#include "math/single.hpp"
#include "math/vec.hpp"

namespace breccia {

template <class R>
using BitsOf = typename TypesOf<R>::Bits;

/// Bits as if by chance, from a number that hardly ever comes again and a count.
/// (Steele, Lea and Flood 2014: the finalizer of splitmix64.)
template <class R>
BR_HD BitsOf<R> chance_of(const R& number, std::int64_t count) {
  BitsOf<R> word;
  __builtin_memcpy(&word, &number, sizeof word);
  word += static_cast<std::uint64_t>(count) * 0x9e3779b97f4a7c15UL;
  word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9UL;
  word = (word ^ (word >> 27)) * 0x94d049bb133111ebUL;
  return word ^ (word >> 31);
}

/// A number that single precision holds: one of the two neighbours of `number`, up if the bits say
/// so.
template <class R>
BR_HD R rounded_by(const BitsOf<R>& chance, const R& number) {
  constexpr std::uint64_t lost = (std::uint64_t{1} << 29) - 1;  // bits that single precision lacks
  BitsOf<R> bits;
  __builtin_memcpy(&bits, &number, sizeof bits);
  bits = (bits + (chance & lost)) & ~lost;
  R rounded;
  __builtin_memcpy(&rounded, &bits, sizeof rounded);
  return rounded;
}

/// As above for a number in single precision. (Wellons 2018, lowbias32.)
template <class V>
BR_HD BitsOf<SingleOf<V>> chance_of(const SingleOf<V>& number, std::int64_t count) {
  BitsOf<SingleOf<V>> word;
  __builtin_memcpy(&word, &number, sizeof word);
  word += static_cast<std::uint32_t>(count) * 0x9e3779b9U;
  word = (word ^ (word >> 16)) * 0x7feb352dU;
  word = (word ^ (word >> 15)) * 0x846ca68bU;
  return word ^ (word >> 16);
}
/// a + b in single precision: one of the two neighbours of the exact sum, up as often as the upper
/// one is near. b is shifted by chance, by less than half a last bit of a, before it is added:
/// where b is 0 the sum is a, but for powers of two, which have a nearer neighbour.
/// @param first  the bit of `chance` to begin with
template <class V>
BR_HD SingleOf<V> sum_by(const BitsOf<SingleOf<V>>& chance, int first, const SingleOf<V>& a,
                         const SingleOf<V>& b) {
  using R = SingleOf<V>;
  const BitsOf<R> exponent = detail::bits_as<BitsOf<R>>(a) & 0x7f800000U;
  const BitsOf<R> turned = first == 0 ? chance : (chance << first | chance >> (32 - first));
  // one of 2^22 numbers within 1/2 from 0, none of them 0 or 1/2, times the last bit
  const R share = signed_value<R>((turned & 0xfffffc00U) | 0x200U);
  return a + (b + 0x1p-55 * share * detail::bits_as<R>(exponent));
}
template <class V>
BR_HD Vec3Of<SingleOf<V>> sum_by(const BitsOf<SingleOf<V>>& chance, int first,
                                 const Vec3Of<SingleOf<V>>& a, const Vec3Of<SingleOf<V>>& b) {
  return {sum_by(chance, first, a.x, b.x), sum_by(chance, first + 5, a.y, b.y),
          sum_by(chance, first + 10, a.z, b.z)};
}

/// Rounds a vector by chance; three components share the bits from `first` on.
template <class R>
BR_HD Vec3Of<R> rounded_by(const BitsOf<R>& chance, int first, const Vec3Of<R>& v) {
  return {rounded_by<R>(chance >> first, v.x), rounded_by<R>(chance >> (first + 6), v.y),
          rounded_by<R>(chance >> (first + 12), v.z)};
}

}  // namespace breccia
