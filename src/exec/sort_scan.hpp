#pragma once
// Sorting and prefix sums: a well-kept library on each side (libstdc++'s parallel mode on the
// host).

#include <cstdint>

#include "exec/buffer.hpp"

namespace breccia {

/// A key and the item it belongs to.
struct KeyedIndex {
  std::uint64_t key;
  Index item;
};

/// Sorts by key, then by item: one order on every machine.
void sort_by_key(const Exec& exec, Buffer<KeyedIndex>& items);

/// Replaces counts by the sum of all counts before them; returns the total.
/// @throws std::length_error if the total does not fit an Index
Index exclusive_scan(const Exec& exec, Buffer<Index>& counts);

}  // namespace breccia
