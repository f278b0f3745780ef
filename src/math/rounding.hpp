#pragma once
// Rounding to single precision by chance.
//
// A sum of many small steps must not be rounded to the nearest: a step below half the last bit
// would be lost, every time. Rounded up as often as the upper neighbour is near, sums are right on
// average. Chance is a hash of numbers that every thread, rank and device has alike.

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
/// Rounds a vector by chance; three components share the bits from `first` on.
template <class R>
BR_HD Vec3Of<R> rounded_by(const BitsOf<R>& chance, int first, const Vec3Of<R>& v) {
  return {rounded_by<R>(chance >> first, v.x), rounded_by<R>(chance >> (first + 6), v.y),
          rounded_by<R>(chance >> (first + 12), v.z)};
}

}  // namespace breccia
