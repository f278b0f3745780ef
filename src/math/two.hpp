#pragma once
// Two numbers, packs or pairs of them side by side: where each operation waits for the one before,
// both take as long as one. Same arithmetic for each, and so the same bits.

#include <type_traits>

#include "math/pack.hpp"

namespace breccia {

template <class R>
struct Two {
  R one, other;
};
template <class R>
inline constexpr bool is_two = false;
template <class R>
inline constexpr bool is_two<Two<R>> = true;

/// An operation of two with two others, or with one number for both.
#define BR_OF_TWO(op)                                                                       \
  template <class R>                                                                        \
  BR_HD inline auto operator op(const Two<R>& x, const Two<R>& y) {                         \
    return Two<decltype(x.one op y.one)>{x.one op y.one, x.other op y.other};               \
  }                                                                                         \
  template <class R, class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0> \
  BR_HD inline auto operator op(const Two<R>& x, Number y) {                                \
    return Two<decltype(x.one op y)>{x.one op y, x.other op y};                             \
  }                                                                                         \
  template <class R, class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0> \
  BR_HD inline auto operator op(Number x, const Two<R>& y) {                                \
    return Two<decltype(x op y.one)>{x op y.one, x op y.other};                             \
  }
BR_OF_TWO(+)
BR_OF_TWO(-)
BR_OF_TWO(*)
BR_OF_TWO(/)
BR_OF_TWO(>)
BR_OF_TWO(|)
BR_OF_TWO(&)
BR_OF_TWO(<<)
BR_OF_TWO(>>)
#undef BR_OF_TWO

template <class R>
BR_HD inline Two<R> max(const Two<R>& x, const Two<R>& y) {
  return {max(x.one, y.one), max(x.other, y.other)};
}
template <class R>
BR_HD inline Two<R> min(const Two<R>& x, const Two<R>& y) {
  return {min(x.one, y.one), min(x.other, y.other)};
}
template <class Truth, class R>
BR_HD inline Two<R> select(const Two<Truth>& condition, const Two<R>& yes, const Two<R>& no) {
  return {select(condition.one, yes.one, no.one), select(condition.other, yes.other, no.other)};
}
template <class R>
struct TypesOf<Two<R>> {
  using Bits = Two<typename TypesOf<R>::Bits>;
};

}  // namespace breccia
