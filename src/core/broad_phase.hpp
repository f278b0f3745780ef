#pragma once
// The one search: pairs of boxes that overlap, found with sorted uniform grids.

#include <cstdint>

#include "core/pair_list.hpp"
#include "exec/sort_scan.hpp"
#include "math/vec.hpp"

namespace breccia {

/// An axis-aligned box, closed: boxes that share only a border overlap.
struct Box {
  Vec3 low, high;  ///< corners  [m]
};

/// Pairs that a search leaves out, in rows of compressed form. Elements are named by their place in
/// the order of global ids.
struct KnownPairs {
  View<const Index> starts;    ///< first partner of each element, and the end; empty: none
  View<const Index> partners;  ///< elements with higher ids

  BR_HD bool operator()(Index one, Index other) const {
    if (starts.size == 0) return false;
    const Index low = one < other ? one : other, high = one < other ? other : one;
    for (Index k = starts[low]; k < starts[low + 1]; ++k)
      if (partners[k] == high) return true;
    return false;
  }
};

struct CellGrid;
struct CellWalk;

/// Finds all pairs of boxes that overlap, of spheres in 3D as of triangles in 2D or 3D.
///
/// Source: Durand et al. 2012, section 4.3 (grid, sort by cell, half of the neighbour cells), with
/// these departures:
/// - One grid for each power of two of the sizes. An element looks for others of its own size in
///   half of the neighbour cells (13 and its own, 4 and its own in 2D), and for larger ones in the
///   larger ones' grid: one large element does not make the cells of all others large.
/// - Cells are counted from the first box on and numbered by as many bits as that takes, but modulo
///   2^21 x 2^19 x 2^19, so no array grows with empty space. Boxes that overlap lie at most one
///   cell apart, so the wrong cell that shares a number never holds a box that overlaps: the test
///   of the boxes makes the search exact, the grid only makes it fast.
/// - The x neighbours of a cell lie next to it in the sorted order, so a cell and its neighbours
///   are five runs of elements (two in 2D), found by walking along the sorted numbers.
///
/// Cost: one sort of the elements and one of the pairs, both by digits; all of it linear in time
/// and memory. A device notes pairs in the rows of their lower ids in place of the second sort, if
/// there are few elements and no row is long. Boxes that all start at the same z are searched in
/// two dimensions.
class BroadPhase {
 public:
  explicit BroadPhase(Space space = Space::host);

  /// All pairs whose boxes overlap, each once, by ascending key: the same on every machine, for
  /// any order of the elements in memory.
  ///
  /// @param boxes  one an element, already grown by the element's own margin  [m]
  /// @param ids    global ids of the same elements, no two alike
  /// @param pairs  gets the pairs; its memory is used again
  /// @param known  pairs that it does not get
  /// @throws NumericsError if a box is not finite, InputError if its corners are swapped or two
  ///         elements share an id (all name the element)
  void search(const Exec& exec, const Buffer<Box>& boxes, const Buffer<GlobalId>& ids, Pairs& pairs,
              const KnownPairs& known = {});

  /// Pairs of boxes that the last search compared: its cost.
  std::int64_t tested(const Exec& exec) const;

 private:
  /// @param in_order  whether ids ascend
  void rank_elements(const Exec& exec, const Buffer<GlobalId>& ids, bool in_order);
  void sort_elements(const Exec& exec, const CellGrid& grid, const Buffer<Box>& boxes);
  /// Lists pairs by the rows of their lower ids. @returns false if some row has no room for its own
  bool list_by_rows(const Exec& exec, const CellWalk& walk, const KnownPairs& known, Pairs& pairs);
  /// Lists them in the order of cells, and sorts them.
  void list_sorted(const Exec& exec, const CellWalk& walk, const KnownPairs& known, Pairs& pairs);

  Buffer<KeyedIndex> cells_;            ///< number of the cell and element, sorted
  Buffer<std::uint64_t> keys_;          ///< the numbers alone
  Buffer<Index> items_, item_scratch_;  ///< the elements alone
  Buffer<Box> boxes_;                   ///< in that order
  Buffer<Index> ranks_;                 ///< place by global id, in that order
  Buffer<KeyedIndex> by_id_;            ///< element at each place by global id
  Buffer<Index> rank_of_;               ///< place by global id of each element
  Buffer<Index> starts_;                ///< first pair that each finds
  Buffer<Index> slots_;                 ///< the first few partners that each finds
  Buffer<Index> overflow_;              ///< other than 0: a row is full
  bool rows_overflow_ = false;
  Buffer<std::uint64_t> packed_, scratch_;  ///< pairs of ranks, each in one number
  Buffer<std::int64_t> tests_;              ///< comparisons of each run of elements
};

}  // namespace breccia
