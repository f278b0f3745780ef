#pragma once
// Sorting and prefix sums in the memory of a GPU; exec/sort_scan chooses.

#include "exec/sort_scan.hpp"

namespace breccia {

/// As the functions of exec/sort_scan without `_on_device`, of arrays in the space `cuda`.
/// Items must come in ascending order, as a grid numbers them.
void sort_by_key_on_device(Buffer<KeyedIndex>& items);
void sort_keys_on_device(Buffer<std::uint64_t>& keys, Buffer<std::uint64_t>& scratch, int bits);
/// Sorts keys below 2^bits and what they carry, stable.
/// @param scratch  like each; holds nothing of use after
void sort_pairs_on_device(Buffer<std::uint64_t>& keys, Buffer<Index>& carried,
                          Buffer<std::uint64_t>& key_scratch, Buffer<Index>& scratch, int bits);
/// Returns the total, however large, and the flag, if it asks for them.
Scanned exclusive_scan_on_device(Buffer<Index>& counts, const Index* flag, bool asks);

}  // namespace breccia
