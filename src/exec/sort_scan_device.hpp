#pragma once
// Sorting and prefix sums in the memory of a GPU; exec/sort_scan chooses.

#include "exec/sort_scan.hpp"

namespace breccia {

/// As the functions of exec/sort_scan without `_on_device`, of arrays in the space `cuda`.
/// Items must come in ascending order, as a grid numbers them.
void sort_by_key_on_device(Buffer<KeyedIndex>& items);
void sort_keys_on_device(Buffer<std::uint64_t>& keys, Buffer<std::uint64_t>& scratch, int bits);
/// Returns the total, however large. The last count must be zero, and none above their number.
std::int64_t exclusive_scan_on_device(Buffer<Index>& counts);

}  // namespace breccia
