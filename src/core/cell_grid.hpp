#pragma once
// Cells of the search: their sizes, their numbers, and the walk over the neighbours of an element.

#include <cstdint>

#include "core/broad_phase.hpp"
#include "core/rows.hpp"

namespace breccia {

constexpr Index finest_level = 31;

/// Grids of cubic cells, one for each power of two of the sizes. A box belongs to level l if its
/// size lies within 1/2 and 1 of largest / 2^l, and to the cell of that level where its low corner
/// lies. The cells of a level are as wide as its largest box, and 1/256 of that.
///
/// Two boxes that overlap, neither larger than the largest of a level, lie in cells of that level
/// at most one apart on each axis: their low corners differ by no more than 256/257 cell widths,
/// and the place in cells, at most 2^42 from the first, is rounded by no more than 1/1024: twice,
/// as it is counted from there and as it is divided. Cells further out than that are counted as the
/// outermost one, which brings no two neighbours further apart.
struct CellGrid {
  double largest = -1.0;       ///< size of the largest box, below 0 if all are points  [m]
  bool planar = false;         ///< all boxes start at the same z: one layer of cells
  std::uint32_t occupied = 0;  ///< bit l: some box belongs to level l
  double inverse[finest_level + 1] = {};  ///< 1 / width of the cells of each level  [1/m]
  Vec3 first;  ///< least low corner of all boxes: cells are counted from there  [m]
  /// Of a cell's number: enough for the cells that low corners have, and those next to them, but no
  /// more than these.
  int x_bits = most_x_bits, y_bits = most_bits, z_bits = most_bits;

  static constexpr int most_x_bits = 21, most_bits = 19, level_bits = 5;

  /// The longest edge of a box that the grid knows of.
  BR_HD double size(const Box& box) const {
    const double plane = max(box.high.x - box.low.x, box.high.y - box.low.y);
    return planar ? plane : max(plane, box.high.z - box.low.z);
  }
  BR_HD Index level(const Box& box) const {
    double twice = 2.0 * size(box);
    Index level = 0;
    for (; level < finest_level && twice <= largest; ++level) twice *= 2.0;
    return level;
  }
  BR_HD std::int64_t cell(double place, Index level) const {
    constexpr double outermost = 4398046511104.0;  // 2^42
    double t = place * inverse[level];
    t = min(max(t, -outermost), outermost);
    const auto whole = static_cast<std::int64_t>(t);
    return whole - (t < static_cast<double>(whole) ? 1 : 0);
  }
  /// Of a place, which cell of a level along each axis.
  BR_HD std::int64_t cell_x(const Vec3& place, Index level) const {
    return cell(place.x - first.x, level);
  }
  BR_HD std::int64_t cell_y(const Vec3& place, Index level) const {
    return cell(place.y - first.y, level);
  }
  BR_HD std::int64_t cell_z(const Vec3& place, Index level) const {
    return planar ? 0 : cell(place.z - first.z, level);
  }

  /// The number of a cell along x, modulo 2^x_bits; the seam lies before the first cell but one.
  BR_HD std::uint64_t column(std::int64_t x) const {
    return static_cast<std::uint64_t>(x + 1) & ((1ULL << x_bits) - 1);
  }
  /// The number of the first cell of a row: level, z and y modulo 2^z_bits and 2^y_bits.
  BR_HD std::uint64_t row(Index level, std::int64_t z, std::int64_t y) const {
    const auto wrapped_z = static_cast<std::uint64_t>(z) & ((1ULL << z_bits) - 1);
    const auto wrapped_y = static_cast<std::uint64_t>(y) & ((1ULL << y_bits) - 1);
    return (static_cast<std::uint64_t>(level) << (x_bits + y_bits + z_bits)) |
           (wrapped_z << (x_bits + y_bits)) | (wrapped_y << x_bits);
  }
  BR_HD Index level_of(std::uint64_t key) const {
    return static_cast<Index>(key >> (x_bits + y_bits + z_bits));
  }
  /// Keys are below 2 to this.
  int key_bits() const {
    int levels = 0;
    while (levels < level_bits && (occupied >> (1U << levels)) != 0) ++levels;
    return levels + x_bits + y_bits + z_bits;
  }
  BR_HD std::uint64_t key(const Box& box) const {
    const Index own = level(box);
    return row(own, cell_z(box.low, own), cell_y(box.low, own)) | column(cell_x(box.low, own));
  }
};

BR_HD inline bool overlap(const Box& a, const Box& b) {
  // One branch for six comparisons: their outcomes are hard to predict.
  return static_cast<bool>(
      static_cast<int>(a.low.x <= b.high.x) & static_cast<int>(b.low.x <= a.high.x) &
      static_cast<int>(a.low.y <= b.high.y) & static_cast<int>(b.low.y <= a.high.y) &
      static_cast<int>(a.low.z <= b.high.z) & static_cast<int>(b.low.z <= a.high.z));
}

/// The walk: for a run of elements, in the order of their cells, all pairs that they find. An
/// element finds those of its own level in the second half of the neighbour cells, or after itself
/// in its own, and those of all coarser levels: each pair is found by one of its two elements.
struct CellWalk {
  CellGrid grid;
  Index run_length = 1;            ///< elements a run
  View<const std::uint64_t> keys;  ///< ascending
  View<const Box> boxes;           ///< in that order

  BR_HD Index first(Index run) const { return run * run_length; }
  BR_HD Index last(Index run) const {
    return keys.size - first(run) < run_length ? keys.size : first(run) + run_length;
  }

  /// Calls found(p, q) for every overlapping pair that elements begin to end - 1 find; returns the
  /// number of comparisons.
  template <class Found>
  BR_HD std::int64_t walk(Index begin, Index end, const Found& found) const {
    const Index finest = grid.level_of(keys[end - 1]);
    std::int64_t tests = 0;
    for (Index level = 0; level <= finest; ++level) {
      if ((grid.occupied >> level & 1U) == 0) continue;
      Index cursors[9] = {-1, -1, -1, -1, -1, -1, -1, -1, -1};
      for (Index p = begin; p < end; ++p)
        if (grid.level_of(keys[p]) >= level) tests += walk_level(level, p, cursors, found);
    }
    return tests;
  }

 private:
  template <class Found>
  BR_HD std::int64_t walk_level(Index level, Index p, Index* cursors, const Found& found) const {
    const Box box = boxes[p];
    const bool own_level = grid.level_of(keys[p]) == level;
    const std::int64_t x = grid.cell_x(box.low, level), y = grid.cell_y(box.low, level),
                       z = grid.cell_z(box.low, level);
    // A partner starts no later than this box ends.
    const std::int64_t x_last = grid.cell_x(box.high, level), y_last = grid.cell_y(box.high, level),
                       z_last = grid.cell_z(box.high, level);
    const std::uint64_t begin = grid.column(x - 1), last = grid.column(x_last);
    const std::uint64_t seam = (1ULL << grid.x_bits) - 1;

    std::int64_t tests = 0;
    for (std::int64_t row_z = own_level || grid.planar ? z : z - 1; row_z <= z_last; ++row_z) {
      for (std::int64_t row_y = own_level && row_z == z ? y : y - 1; row_y <= y_last; ++row_y) {
        const std::uint64_t row = grid.row(level, row_z, row_y);
        const bool own_row = own_level && row_z == z && row_y == y;
        Index& cursor = cursors[3 * (row_z - z + 1) + (row_y - y + 1)];
        const std::uint64_t from = own_row ? grid.column(x) : begin;
        cursor = own_row ? p + 1 : seek(cursor, row | from);
        if (from <= last) {
          tests += compare(p, box, cursor, row | last, found);
        } else {  // the row crosses the seam of the numbers
          tests += compare(p, box, cursor, row | seam, found);
          tests += compare(p, box, seek(-1, row), row | last, found);
        }
      }
    }
    return tests;
  }

  /// Compares with everything from place q to the last of the cell numbered `last`.
  template <class Found>
  BR_HD std::int64_t compare(Index p, const Box& box, Index q, std::uint64_t last,
                             const Found& found) const {
    const Index start = q;
    for (; q < keys.size && keys[q] <= last; ++q)
      if (overlap(box, boxes[q])) found(p, q);
    return q - start;
  }

  /// The first place whose key is not below `key`, sought from `hint` on in growing steps; the
  /// next element's neighbours lie just behind this one's. A hint below 0 gives no help.
  BR_HD Index seek(Index hint, std::uint64_t key) const {
    const Index count = keys.size;
    if (hint < 0) return lower_bound(keys.data, 0, count, key);
    if (hint > 0 && keys[hint - 1] >= key) return lower_bound(keys.data, 0, hint - 1, key);
    Index low = hint, step = 1;
    while (step <= count - low && keys[low + step - 1] < key) {
      low += step;
      step *= 2;
    }
    return lower_bound(keys.data, low, step <= count - low ? low + step - 1 : count, key);
  }
};

}  // namespace breccia
