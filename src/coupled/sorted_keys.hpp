#pragma once
// Sorted numbers, and keys of two of them, each once: lists between spheres and tetrahedra.

#include <bit>

#include "core/pair_list.hpp"
#include "core/select.hpp"

namespace breccia::coupled {

/// The first of `count` places, in the order of their numbers, whose number is not below `value`.
template <class Number>
BR_HD Index first_from(Index count, Index value, const Number& number) {
  Index first = 0, last = count;
  while (first < last) {
    const Index middle = first + (last - first) / 2;
    if (number(middle) < value)
      first = middle + 1;
    else
      last = middle;
  }
  return first;
}

BR_HD inline PairKey key_of(Index sphere, Index other) {
  return (static_cast<PairKey>(static_cast<std::uint32_t>(sphere)) << 32) |
         static_cast<std::uint32_t>(other);
}

/// Of sorted keys those that are not like the one before.
struct IsFirst {
  View<const PairKey> key;
  BR_HD bool operator()(Index i) const { return i == 0 || key[i] != key[i - 1]; }
};
/// Sorts keys; each that is there stays once.
/// @param below  bound of the higher half
inline void sort_once(const Exec& exec, Buffer<PairKey>& keys, Index below) {
  Buffer<PairKey> scratch(exec.space);
  sort_keys(exec, keys, scratch, 32 + std::bit_width(static_cast<std::uint32_t>(below)));
  const Buffer<Index> kept = items_where(exec, keys.size(), IsFirst{std::as_const(keys).view()});
  gather(exec, kept, keys);
}

struct EndsOfKeys {
  static constexpr const char* name = "coupled.ends_of_keys";
  View<const PairKey> key;
  View<Index> a, b;
  BR_HD void operator()(Index i) const {
    a[i] = low_id(key[i]);
    b[i] = high_id(key[i]);
  }
};
/// Pairs of the numbers of keys.
inline Pairs pairs_of(const Exec& exec, Buffer<PairKey>&& keys, Index below) {
  sort_once(exec, keys, below);
  Pairs pairs(exec.space);
  pairs.key = std::move(keys);
  pairs.a.resize(pairs.size());
  pairs.b.resize(pairs.size());
  for_each(exec, pairs.size(),
           EndsOfKeys{std::as_const(pairs.key).view(), pairs.a.view(), pairs.b.view()});
  return pairs;
}

}  // namespace breccia::coupled
