#pragma once
// Filling compressed rows in parallel: slots are taken in any order, then each row is sorted, so
// the order in which threads came leaves no trace.

#include "exec/types.hpp"

namespace breccia {

/// Adds one to a counter that other threads count in too; returns what it was.
BR_HD inline Index count_up(Index& counter, Index by = 1) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(&counter, by);
#else
  return __atomic_fetch_add(&counter, by, __ATOMIC_RELAXED);
#endif
}
BR_HD inline void count_up(std::uint64_t& counter, std::uint64_t by) {
#if defined(__CUDA_ARCH__)
  static_assert(sizeof(unsigned long long) == sizeof(std::uint64_t));
  atomicAdd(reinterpret_cast<unsigned long long*>(&counter), static_cast<unsigned long long>(by));
#else
  __atomic_fetch_add(&counter, by, __ATOMIC_RELAXED);
#endif
}

/// Moves the item at `top` of a heap of `count` items down to where it belongs.
template <class T, class Before>
BR_HD void sift_down(T* items, Index top, Index count, const Before& before) {
  const T moved = items[top];
  for (Index child = 2 * top + 1; child < count; child = 2 * top + 1) {
    if (child + 1 < count && before(items[child], items[child + 1])) ++child;
    if (!before(moved, items[child])) break;
    items[top] = items[child];
    top = child;
  }
  items[top] = moved;
}

/// Sorts one row in place: by insertion when short, as a heap when long.
/// @param before  a strict order in which no two items are equal
template <class T, class Before>
BR_HD void sort_row(T* items, Index count, const Before& before) {
  constexpr Index longest_inserted = 32;
  if (count <= longest_inserted) {
    for (Index i = 1; i < count; ++i) {
      const T moved = items[i];
      Index at = i;
      for (; at > 0 && before(moved, items[at - 1]); --at) items[at] = items[at - 1];
      items[at] = moved;
    }
    return;
  }
  for (Index top = count / 2 - 1; top >= 0; --top) sift_down(items, top, count, before);
  for (Index last = count - 1; last > 0; --last) {
    const T largest = items[0];
    items[0] = items[last];
    items[last] = largest;
    sift_down(items, 0, last, before);
  }
}

/// The first place in the sorted items [first, last) that does not lie before `value`.
template <class T>
BR_HD Index lower_bound(const T* items, Index first, Index last, const T& value) {
  while (first < last) {
    const Index middle = first + (last - first) / 2;
    if (items[middle] < value)
      first = middle + 1;
    else
      last = middle;
  }
  return first;
}

}  // namespace breccia
