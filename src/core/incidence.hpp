#pragma once
// Who touches me: for each element the pairs it belongs to, in an order that no machine changes.

#include "exec/buffer.hpp"

namespace breccia {

/// A pair and the end of it that an element is: 2 * pair + side, side 0 for a, 1 for b.
using Entry = Index;

BR_HD constexpr Index pair_of(Entry entry) {
  return entry >> 1;
}
BR_HD constexpr Index side_of(Entry entry) {
  return entry & 1;
}

/// An Incidence as kernels see it: entries first(e) to last(e) - 1 belong to element e.
struct IncidenceView {
  View<const Index> starts;
  View<const Entry> entries;

  BR_HD Index first(Index element) const { return starts[element]; }
  BR_HD Index last(Index element) const { return starts[element + 1]; }
};

/// Compressed rows: the entries of all elements, one element after the other.
struct Incidence {
  Buffer<Index> starts;   ///< first entry of each element, and the number of all entries
  Buffer<Entry> entries;  ///< of each element by ascending global id of the partner, then by pair

  explicit Incidence(Space space = Space::host) : starts(space), entries(space) {}
  IncidenceView view() const { return {starts.view(), entries.view()}; }
};

/// The rows of pairs (a[p], b[p]) of memory indices. Sums over a row in its order give the same
/// bits for any order of elements in memory, any thread and any rank count.
///
/// @param ids  global id of each element of memory
/// Cost: linear in pairs; one count, one scan, one fill, one sort a row.
void build_incidence(const Exec& exec, const Buffer<Index>& a, const Buffer<Index>& b,
                     const Buffer<GlobalId>& ids, Incidence& incidence);

}  // namespace breccia
