#pragma once
// Sorting and prefix sums, on the host by digits (radix): linear in the items, and the same order
// for any number of threads.

#include <cstdint>

#include "exec/buffer.hpp"

namespace breccia {

/// A key and the item it belongs to.
struct KeyedIndex {
  std::uint64_t key;
  Index item;
};

/// Sorts by key, then by item: one order on every machine. Views of the array stay good.
void sort_by_key(const Exec& exec, Buffer<KeyedIndex>& items);

/// Sorts numbers that are below 2^bits. The two arrays may exchange their memory: take views after.
/// @param scratch  of the same space; holds nothing of use after
void sort_keys(const Exec& exec, Buffer<std::uint64_t>& keys, Buffer<std::uint64_t>& scratch,
               int bits);

/// Replaces counts by the sum of all counts before them; returns the total.
/// @throws DeviceError if the total does not fit an Index
Index exclusive_scan(const Exec& exec, Buffer<Index>& counts);

/// A scan's answer: the sum of all counts, and a number that kernels before it have left.
struct Scanned {
  std::int64_t total;
  Index flag;
};
/// As that, and the number `flag` by the same look at a device.
/// @param flag  one item
Scanned exclusive_scan(const Exec& exec, Buffer<Index>& counts, const Buffer<Index>& flag);
/// As that where the total is known: nothing is asked of a device.
void exclusive_scan(const Exec& exec, Buffer<Index>& counts, Index total);

}  // namespace breccia
