#include "core/broad_phase.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "core/cell_grid.hpp"
#include "core/step_clock.hpp"
#include "exec/error.hpp"

namespace breccia {
namespace {

constexpr Index none = std::numeric_limits<Index>::max();

/// Partners that an element notes when it first meets them: enough for nearly all elements of a
/// packing, which find about five each.
constexpr Index slots_each = 12;

/// Sizes of all boxes together, from which the cells follow.
struct Extent {
  double plane = -1.0;                                   ///< longest edge in x or y  [m]
  double size = -1.0;                                    ///< longest edge  [m]
  double reach = 0.0;                                    ///< largest coordinate  [m]
  double lowest = std::numeric_limits<double>::max();    ///< first start in z  [m]
  double highest = -std::numeric_limits<double>::max();  ///< last start in z  [m]
  Index infinite = none;                                 ///< first box that is not finite
  Index swapped = none;                                  ///< first box with low above high
};

struct MeasureBox {
  static constexpr const char* name = "core.measure_box";
  View<const Box> boxes;

  BR_HD Extent operator()(Index i) const {
    const Vec3 low = boxes[i].low, high = boxes[i].high;
    Extent extent;
    if (!finite(low) || !finite(high)) {
      extent.infinite = i;
      return extent;
    }
    if (low.x > high.x || low.y > high.y || low.z > high.z) extent.swapped = i;
    extent.plane = max(high.x - low.x, high.y - low.y);
    extent.size = max(extent.plane, high.z - low.z);
    extent.reach = max(reach(low), reach(high));
    extent.lowest = extent.highest = low.z;
    return extent;
  }

 private:
  BR_HD static bool finite(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  }
  BR_HD static double reach(const Vec3& v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }
};

struct JoinExtents {
  BR_HD Extent operator()(const Extent& a, const Extent& b) const {
    Extent both;
    both.plane = max(a.plane, b.plane);
    both.size = max(a.size, b.size);
    both.reach = max(a.reach, b.reach);
    both.lowest = min(a.lowest, b.lowest);
    both.highest = max(a.highest, b.highest);
    both.infinite = Least{}(a.infinite, b.infinite);
    both.swapped = Least{}(a.swapped, b.swapped);
    return both;
  }
};

/// The largest box of each level.
struct LevelSizes {
  double size[finest_level + 1];
};

/// Largest box of each level in one chunk of boxes.
struct MeasureLevels {
  static constexpr const char* name = "core.measure_levels";
  CellGrid grid;
  View<const Box> boxes;

  BR_HD LevelSizes operator()(Index chunk) const {
    LevelSizes sizes = no_sizes();
    const Index first = chunk * fold_chunk;
    const Index end = first + fold_chunk < boxes.size ? first + fold_chunk : boxes.size;
    for (Index i = first; i < end; ++i) {
      double& size = sizes.size[grid.level(boxes[i])];
      size = max(size, grid.size(boxes[i]));
    }
    return sizes;
  }
  BR_HD static LevelSizes no_sizes() {
    LevelSizes sizes;
    for (double& size : sizes.size) size = -1.0;
    return sizes;
  }
};

struct JoinLevels {
  BR_HD LevelSizes operator()(const LevelSizes& a, const LevelSizes& b) const {
    LevelSizes both;
    for (Index level = 0; level <= finest_level; ++level)
      both.size[level] = max(a.size[level], b.size[level]);
    return both;
  }
};

/// Largest box of each level, by all threads of a device: bits of the size plus one; zero: no box.
struct NoteLevelSize {
  static constexpr const char* name = "core.note_level_size";
  CellGrid grid;
  View<const Box> boxes;
  View<std::uint64_t> noted;

  BR_HD void operator()([[maybe_unused]] Index i) const {
#if defined(__CUDA_ARCH__)
    auto* const size = reinterpret_cast<unsigned long long*>(&noted[grid.level(boxes[i])]);
    const unsigned long long own = ordered_bits(grid.size(boxes[i])) + 1;
    if (__ldcg(size) < own) atomicMax(size, own);
#endif
  }
};

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

/// Boxes and ranks side by side in the order of the cells, so that neighbours are read in a row.
struct SortElements {
  static constexpr const char* name = "core.sort_elements";
  View<const KeyedIndex> cells;
  View<const Box> boxes;
  View<const Index> rank_of;
  View<std::uint64_t> keys;
  View<Box> sorted_boxes;
  View<Index> ranks;

  BR_HD void operator()(Index p) const {
    const KeyedIndex cell = cells[p];
    keys[p] = cell.key;
    sorted_boxes[p] = boxes[cell.item];
    ranks[p] = rank_of[cell.item];
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

struct FindPairs {
  static constexpr const char* name = "core.find_pairs";
  CellWalk cells;
  NotePair note;
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

  BR_HD Index operator()(Index i) const { return by_id[i].key < by_id[i + 1].key ? none : i; }
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
  grid.planar = extent.lowest == extent.highest;
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
  return grid;
}

/// Long enough to walk on from element to element, short enough for all threads to have some.
Index run_length(const Exec& exec, Index count) {
  if (exec.space == Space::cuda) return 1;
  const Index share = count / 1024;
  return share < 16 ? 16 : (share > 256 ? 256 : share);
}

void check(const Extent& extent, const Buffer<GlobalId>& ids) {
  if (extent.infinite != none)
    throw NumericsError("element " + std::to_string(item_of(ids, extent.infinite)) +
                        " has a position or size that is not a finite number");
  if (extent.swapped != none)
    throw InputError("element " + std::to_string(item_of(ids, extent.swapped)) +
                     " has a negative size");
}

}  // namespace

BroadPhase::BroadPhase(Space space)
    : cells_(space),
      keys_(space),
      boxes_(space),
      ranks_(space),
      by_id_(space),
      rank_of_(space),
      starts_(space),
      slots_(space),
      packed_(space),
      scratch_(space),
      tests_(space) {}

void BroadPhase::rank_elements(const Exec& exec, const Buffer<GlobalId>& ids) {
  const Index count = ids.size();
  by_id_.resize_unfilled(count);
  rank_of_.resize_unfilled(count);
  for_each(exec, count, NoteId{ids.view(), by_id_.view()});
  const NotAscending not_ascending{by_id_.view()};
  if (fold(exec, count - 1, none, not_ascending, Least{}) != none) {
    sort_by_key(exec, by_id_);
    const Index twin = fold(exec, count - 1, none, not_ascending, Least{});
    if (twin != none)
      throw InputError("two elements have the global id " +
                       std::to_string(item_of(by_id_, twin).key));
  }
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
  const Extent extent = fold(exec, count, Extent{}, MeasureBox{boxes.view()}, JoinExtents{});
  check(extent, ids);
  const CellGrid grid = grid_for(exec, extent, boxes.view());
  rank_elements(exec, ids);

  // Elements in the order of their cells.
  cells_.resize_unfilled(count);
  keys_.resize_unfilled(count);
  boxes_.resize_unfilled(count);
  ranks_.resize_unfilled(count);
  for_each(exec, count, NumberCell{grid, boxes.view(), cells_.view()});
  sort_by_key(exec, cells_);
  for_each(exec, count,
           SortElements{cells_.view(), boxes.view(), rank_of_.view(), keys_.view(), boxes_.view(),
                        ranks_.view()});

  // Count, scan, fill.
  const CellWalk walk{grid, run_length(exec, count), keys_.view(), boxes_.view()};
  const Index runs = (count + walk.run_length - 1) / walk.run_length;
  tests_.resize_unfilled(runs);
  starts_.clear();
  starts_.resize(count + 1);
  slots_.resize_unfilled(count * slots_each);
  const LeftOut left_out{known, ranks_.view()};
  for_each(exec, runs, FindPairs{walk, {left_out, starts_.view(), slots_.view()}, tests_.view()});
  const Index found = exclusive_scan(exec, starts_);
  packed_.resize_unfilled(found);
  const int rank_bits = std::bit_width(static_cast<std::uint32_t>(count));
  const PackPair pack{ranks_.view(), rank_bits};
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
