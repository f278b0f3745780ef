#include "core/broad_phase.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "core/box_sizes.hpp"
#include "core/cell_grid.hpp"
#include "core/step_clock.hpp"
#include "exec/error.hpp"
#include "exec/sort_scan_device.hpp"

namespace breccia {
namespace {

/// Partners that an element notes when it first meets them: enough for nearly all elements of a
/// packing, which find about five each.
constexpr Index slots_each = 12;
/// Partners with higher ids that there is room for in rows, and the most elements that have them: a
/// device then needs not sort pairs.
constexpr Index slots_of_row = 32, most_in_rows = 2'000'000;

LevelSizes level_sizes(const Exec& exec, const CellGrid& grid, View<const Box> boxes) {
  if (exec.space != Space::cuda)
    return fold(exec, (boxes.size + fold_chunk - 1) / fold_chunk, MeasureLevels::no_sizes(),
                MeasureLevels{grid, boxes}, JoinLevels{});
  Buffer<std::uint64_t> noted(exec.space, finest_level + 1);
  for_each(exec, boxes.size, NoteLevelSize{grid, boxes, noted.view()});
  std::vector<std::uint64_t> bits;
  copy_to(bits, noted);
  LevelSizes sizes = MeasureLevels::no_sizes();
  for (std::size_t level = 0; level < bits.size(); ++level)
    if (bits[level] != 0) sizes.size[level] = number_of(bits[level] - 1);
  return sizes;
}

struct NumberCell {
  static constexpr const char* name = "core.number_cell";
  CellGrid grid;
  View<const Box> boxes;
  View<KeyedIndex> cells;

  BR_HD void operator()(Index i) const { cells[i] = {grid.key(boxes[i]), i}; }
};

/// Numbers and elements in arrays of their own, as a device sorts them.
struct NumberCellApart {
  static constexpr const char* name = "core.number_cell";
  CellGrid grid;
  View<const Box> boxes;
  View<std::uint64_t> keys;
  View<Index> items;

  BR_HD void operator()(Index i) const {
    keys[i] = grid.key(boxes[i]);
    items[i] = i;
  }
};

struct SplitCell {
  static constexpr const char* name = "core.split_cell";
  View<const KeyedIndex> cells;
  View<std::uint64_t> keys;
  View<Index> items;

  BR_HD void operator()(Index p) const {
    keys[p] = cells[p].key;
    items[p] = cells[p].item;
  }
};

/// Boxes and ranks side by side in the order of the cells, so that neighbours are read in a row.
struct SortElements {
  static constexpr const char* name = "core.sort_elements";
  View<const Index> items;
  View<const Box> boxes;
  View<const Index> rank_of;
  View<Box> sorted_boxes;
  View<Index> ranks;

  BR_HD void operator()(Index p) const {
    const Index item = items[p];
    sorted_boxes[p] = boxes[item];
    ranks[p] = rank_of[item];
  }
};

/// Pairs to leave out, by places in the order of the cells.
struct LeftOut {
  KnownPairs known;
  View<const Index> ranks;
  BR_HD bool operator()(Index p, Index q) const { return known(ranks[p], ranks[q]); }
};

/// Notes what the elements of a run find: their number, and the first few of them.
struct NotePair {
  LeftOut left_out;
  View<Index> counts;  ///< zero before
  View<Index> slots;

  BR_HD void operator()(Index p, Index q) const {
    if (left_out(p, q)) return;
    const Index count = counts[p]++;
    if (count < slots_each) slots[p * slots_each + count] = q;
  }
};

/// Notes each pair in the row of its lower rank, in any order.
struct NoteInRow {
  LeftOut left_out;
  View<Index> counts;    ///< of each rank; zero before
  View<Index> slots;     ///< the higher ranks
  View<Index> overflow;  ///< one item: other than 0 where a row has more than its slots

  BR_HD void operator()(Index p, Index q) const {
    if (left_out(p, q)) return;
    const Index one = left_out.ranks[p], other = left_out.ranks[q];
    const Index low = one < other ? one : other, high = one < other ? other : one;
    const Index place = count_up(counts[low]);
    if (place < slots_of_row)
      slots[low * slots_of_row + place] = high;
    else
      count_up(overflow[0]);
  }
};

template <class Note>
struct FindPairs {
  static constexpr const char* name = "core.find_pairs";
  CellWalk cells;
  Note note;
  View<std::int64_t> tests;

  BR_HD void operator()(Index run) const {
    tests[run] = cells.walk(cells.first(run), cells.last(run), note);
  }
};

/// A pair as one number that sorts like its key: the ranks of its ids.
struct PackPair {
  View<const Index> ranks;
  int rank_bits;

  BR_HD std::uint64_t operator()(Index p, Index q) const {
    const Index a = ranks[p], b = ranks[q];
    const auto low = static_cast<std::uint64_t>(a < b ? a : b);
    return low << rank_bits | static_cast<std::uint64_t>(a < b ? b : a);
  }
};

/// Writes all pairs of one element.
struct WritePairs {
  LeftOut left_out;
  PackPair pack;
  View<const Index> starts;
  View<Index> written;  ///< so far, by the element's first slot
  View<std::uint64_t> packed;

  BR_HD void operator()(Index p, Index q) const {
    if (left_out(p, q)) return;
    packed[starts[p] + written[p * slots_each]++] = pack(p, q);
  }
};

/// Writes the pairs of a run of elements from their slots; one that has found more walks again.
struct PackPairs {
  static constexpr const char* name = "core.pack_pairs";
  CellWalk cells;
  WritePairs write;
  View<Index> slots;

  BR_HD void operator()(Index run) const {
    for (Index p = cells.first(run); p < cells.last(run); ++p) {
      const Index start = write.starts[p], count = write.starts[p + 1] - start;
      if (count > slots_each) {
        slots[p * slots_each] = 0;
        cells.walk(p, p + 1, write);
      } else {
        for (Index i = 0; i < count; ++i)
          write.packed[start + i] = write.pack(p, slots[p * slots_each + i]);
      }
    }
  }
};

struct UnpackPairs {
  static constexpr const char* name = "core.unpack_pairs";
  View<const std::uint64_t> packed;
  View<const KeyedIndex> by_id;
  int rank_bits;
  View<PairKey> key;
  View<Index> a, b;

  BR_HD void operator()(Index i) const {
    const std::uint64_t pair = packed[i];
    const KeyedIndex low = by_id[static_cast<Index>(pair >> rank_bits)];
    const KeyedIndex high = by_id[static_cast<Index>(pair & ((1ULL << rank_bits) - 1))];
    key[i] = low.key << 32 | high.key;
    a[i] = low.item;
    b[i] = high.item;
  }
};

/// Pairs of one row, ascending.
struct WriteRow {
  static constexpr const char* name = "core.write_row";
  View<const Index> starts;
  View<Index> slots;
  View<const KeyedIndex> by_id;
  View<PairKey> key;
  View<Index> a, b;

  struct Before {
    BR_HD bool operator()(Index one, Index other) const { return one < other; }
  };
  BR_HD void operator()(Index low) const {
    const Index start = starts[low], count = starts[low + 1] - start;
    if (count == 0) return;
    Index* const row = &slots[low * slots_of_row];
    if (count > 1) sort_row(row, count, Before{});
    const KeyedIndex own = by_id[low];
    for (Index k = 0; k < count; ++k) {
      const KeyedIndex high = by_id[row[k]];
      key[start + k] = own.key << 32 | high.key;
      a[start + k] = own.item;
      b[start + k] = high.item;
    }
  }
};

/// Ranks of elements whose ids ascend.
struct RankInOrder {
  static constexpr const char* name = "core.rank_in_order";
  View<const GlobalId> ids;
  View<KeyedIndex> by_id;
  View<Index> rank_of;

  BR_HD void operator()(Index i) const {
    BR_ASSERT(ids[i] >= 0);
    by_id[i] = {static_cast<std::uint32_t>(ids[i]), i};
    rank_of[i] = i;
  }
};

struct NoteId {
  static constexpr const char* name = "core.note_id";
  View<const GlobalId> ids;
  View<KeyedIndex> by_id;

  BR_HD void operator()(Index i) const {
    BR_ASSERT(ids[i] >= 0);
    by_id[i] = {static_cast<std::uint32_t>(ids[i]), i};
  }
};

/// The first place where the next id is not larger.
struct NotAscending {
  View<const KeyedIndex> by_id;

  BR_HD Index operator()(Index i) const { return by_id[i].key < by_id[i + 1].key ? no_box : i; }
};

struct RankElement {
  static constexpr const char* name = "core.rank_element";
  View<const KeyedIndex> by_id;
  View<Index> rank_of;

  BR_HD void operator()(Index rank) const { rank_of[by_id[rank].item] = rank; }
};

struct AddTests {
  View<const std::int64_t> tests;
  BR_HD std::int64_t operator()(Index run) const { return tests[run]; }
};

template <class T>
T item_of(const Buffer<T>& items, Index i) {
  T item;
  copy_bytes(&item, Space::host, items.data() + i, items.space(), sizeof(T));
  return item;
}

CellGrid grid_for(const Exec& exec, const Extent& extent, View<const Box> boxes) {
  CellGrid grid;
  grid.planar = extent.first.z == extent.last.z;
  grid.first = extent.first;
  const double size = grid.planar ? extent.plane : extent.size;
  if (size > 0.0) grid.largest = size;
  const LevelSizes sizes = level_sizes(exec, grid, boxes);

  // Among points any width will do; points among boxes are on the finest level.
  const double for_points = size > 0.0 ? size / 2147483648.0 : extent.reach / 1048576.0;
  constexpr double smallest = 1e-290;  // its inverse is still a number
  for (Index level = 0; level <= finest_level; ++level) {
    if (sizes.size[level] < 0.0) continue;
    const double width = sizes.size[level] > 0.0 ? sizes.size[level] : for_points;
    grid.occupied |= 1U << level;
    grid.inverse[level] = 1.0 / max((1.0 + 1.0 / 256.0) * width, smallest);
  }
  const auto bits = [&](auto cell_of, int most) {
    std::int64_t cells = 0;
    for (Index level = 0; level <= finest_level; ++level)
      if ((grid.occupied >> level & 1U) != 0) cells = std::max(cells, cell_of(level));
    return std::min(most, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(cells + 4))));
  };
  grid.x_bits = bits([&](Index l) { return grid.cell_x(extent.last, l); }, CellGrid::most_x_bits);
  grid.y_bits = bits([&](Index l) { return grid.cell_y(extent.last, l); }, CellGrid::most_bits);
  grid.z_bits =
      grid.planar ? 0
                  : bits([&](Index l) { return grid.cell_z(extent.last, l); }, CellGrid::most_bits);
  return grid;
}

/// Long enough to walk on from element to element, short enough for all threads to have some.
Index run_length(const Exec& exec, Index count) {
  if (exec.space == Space::cuda) return 1;
  const Index share = count / 1024;
  return share < 16 ? 16 : (share > 256 ? 256 : share);
}

void check(const Extent& extent, const Buffer<GlobalId>& ids) {
  if (extent.infinite != no_box)
    throw NumericsError("element " + std::to_string(item_of(ids, extent.infinite)) +
                        " has a position or size that is not a finite number");
  if (extent.swapped != no_box)
    throw InputError("element " + std::to_string(item_of(ids, extent.swapped)) +
                     " has a negative size");
}

}  // namespace

BroadPhase::BroadPhase(Space space)
    : cells_(space),
      keys_(space),
      items_(space),
      item_scratch_(space),
      boxes_(space),
      ranks_(space),
      by_id_(space),
      rank_of_(space),
      starts_(space),
      slots_(space),
      overflow_(space),
      packed_(space),
      scratch_(space),
      tests_(space) {}

void BroadPhase::rank_elements(const Exec& exec, const Buffer<GlobalId>& ids, bool in_order) {
  const Index count = ids.size();
  by_id_.resize_unfilled(count);
  rank_of_.resize_unfilled(count);
  if (in_order)
    return for_each(exec, count, RankInOrder{ids.view(), by_id_.view(), rank_of_.view()});
  for_each(exec, count, NoteId{ids.view(), by_id_.view()});
  sort_by_key(exec, by_id_);
  const Index twin = fold(exec, count - 1, no_box, NotAscending{by_id_.view()}, Least{});
  if (twin != no_box)
    throw InputError("two elements have the global id " +
                     std::to_string(item_of(by_id_, twin).key));
  for_each(exec, count, RankElement{by_id_.view(), rank_of_.view()});
}

void BroadPhase::search(const Exec& exec, const Buffer<Box>& boxes, const Buffer<GlobalId>& ids,
                        Pairs& pairs, const KnownPairs& known) {
  BR_ASSERT(boxes.size() == ids.size());
  const Index count = boxes.size();
  if (count == 0) {
    tests_.clear();
    resize_fields(pairs, 0);
    return;
  }
  if (count > std::numeric_limits<Index>::max() / slots_each)
    throw DeviceError("one search holds at most 178 million elements; use more ranks");

  // Bounding values, and the width of the cells.
  const Extent extent =
      fold(exec, count, Extent{}, MeasureBox{boxes.view(), ids.view()}, JoinExtents{});
  check(extent, ids);
  const CellGrid grid = grid_for(exec, extent, boxes.view());
  rank_elements(exec, ids, extent.unordered == no_box);

  sort_elements(exec, grid, boxes);

  const CellWalk walk{grid, run_length(exec, count), std::as_const(keys_).view(),
                      std::as_const(boxes_).view()};
  if (exec.space != Space::host && count <= most_in_rows && !rows_overflow_) {
    if (list_by_rows(exec, walk, known, pairs)) return;
    rows_overflow_ = true;  // and will again
  }
  list_sorted(exec, walk, known, pairs);
}

void BroadPhase::sort_elements(const Exec& exec, const CellGrid& grid, const Buffer<Box>& boxes) {
  const Index count = boxes.size();
  keys_.resize_unfilled(count);
  items_.resize_unfilled(count);
  boxes_.resize_unfilled(count);
  ranks_.resize_unfilled(count);
  if (exec.space == Space::cuda) {
    for_each(exec, count, NumberCellApart{grid, boxes.view(), keys_.view(), items_.view()});
    sort_pairs_on_device(keys_, items_, scratch_, item_scratch_, grid.key_bits());
  } else {
    cells_.resize_unfilled(count);
    for_each(exec, count, NumberCell{grid, boxes.view(), cells_.view()});
    sort_by_key(exec, cells_);
    for_each(exec, count, SplitCell{std::as_const(cells_).view(), keys_.view(), items_.view()});
  }
  for_each(exec, count,
           SortElements{std::as_const(items_).view(), boxes.view(), std::as_const(rank_of_).view(),
                        boxes_.view(), ranks_.view()});
}

bool BroadPhase::list_by_rows(const Exec& exec, const CellWalk& walk, const KnownPairs& known,
                              Pairs& pairs) {
  const Index count = boxes_.size(), runs = (count + walk.run_length - 1) / walk.run_length;
  tests_.resize_unfilled(runs);
  starts_.clear();
  starts_.resize(count + 1);
  overflow_.clear();
  overflow_.resize(1);
  slots_.resize_unfilled(count * slots_of_row);
  const LeftOut left_out{known, std::as_const(ranks_).view()};
  const NoteInRow note{left_out, starts_.view(), slots_.view(), overflow_.view()};
  for_each(exec, runs, FindPairs<NoteInRow>{walk, note, tests_.view()});
  const Scanned scanned = exclusive_scan(exec, starts_, overflow_);
  if (scanned.flag != 0) return false;
  const auto found = static_cast<Index>(scanned.total);
  pairs.each_field(
      [found](const char*, const char*, auto& array) { array.resize_unfilled(found); });
  for_each(exec, count,
           WriteRow{std::as_const(starts_).view(), slots_.view(), std::as_const(by_id_).view(),
                    pairs.key.view(), pairs.a.view(), pairs.b.view()});
  return true;
}

void BroadPhase::list_sorted(const Exec& exec, const CellWalk& walk, const KnownPairs& known,
                             Pairs& pairs) {
  // Count, scan, fill.
  const Index count = boxes_.size(), runs = (count + walk.run_length - 1) / walk.run_length;
  tests_.resize_unfilled(runs);
  starts_.clear();
  starts_.resize(count + 1);
  slots_.resize_unfilled(count * slots_each);
  const LeftOut left_out{known, std::as_const(ranks_).view()};
  const NotePair note{left_out, starts_.view(), slots_.view()};
  for_each(exec, runs, FindPairs<NotePair>{walk, note, tests_.view()});
  const Index found = exclusive_scan(exec, starts_);
  packed_.resize_unfilled(found);
  const int rank_bits = std::bit_width(static_cast<std::uint32_t>(count));
  const PackPair pack{std::as_const(ranks_).view(), rank_bits};
  for_each(
      exec, runs,
      PackPairs{
          walk, {left_out, pack, starts_.view(), slots_.view(), packed_.view()}, slots_.view()});

  // By ascending key.
  sort_keys(exec, packed_, scratch_, 2 * rank_bits);
  pairs.each_field(
      [found](const char*, const char*, auto& array) { array.resize_unfilled(found); });
  for_each(exec, found,
           UnpackPairs{packed_.view(), by_id_.view(), rank_bits, pairs.key.view(), pairs.a.view(),
                       pairs.b.view()});
}

std::int64_t BroadPhase::tested(const Exec& exec) const {
  return fold(exec, tests_.size(), std::int64_t{0}, AddTests{tests_.view()}, Sum{});
}

}  // namespace breccia
