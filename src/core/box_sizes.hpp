#pragma once
// Sizes of boxes, from which the cells of a search follow: kernels of core/broad_phase.cpp.

#include <cmath>
#include <limits>

#include "core/cell_grid.hpp"
#include "core/step_clock.hpp"
#include "exec/for_each.hpp"

namespace breccia {

/// In place of the number of a box.
inline constexpr Index no_box = std::numeric_limits<Index>::max();

/// Sizes of all boxes together, from which the cells follow.
struct Extent {
  static constexpr double far = std::numeric_limits<double>::max();
  double plane = -1.0;          ///< longest edge in x or y  [m]
  double size = -1.0;           ///< longest edge  [m]
  double reach = 0.0;           ///< largest coordinate  [m]
  Vec3 first{far, far, far};    ///< least of low corners  [m]
  Vec3 last{-far, -far, -far};  ///< and largest  [m]
  Index infinite = no_box;      ///< first box that is not finite
  Index swapped = no_box;       ///< first box with low above high
  Index unordered = no_box;     ///< first element whose id is not below the next one's
};

struct MeasureBox {
  static constexpr const char* name = "core.measure_box";
  View<const Box> boxes;
  View<const GlobalId> ids;

  BR_HD Extent operator()(Index i) const {
    const Vec3 low = boxes[i].low, high = boxes[i].high;
    Extent extent;
    if (i + 1 < ids.size && ids[i] >= ids[i + 1]) extent.unordered = i;
    if (!finite(low) || !finite(high)) {
      extent.infinite = i;
      return extent;
    }
    if (low.x > high.x || low.y > high.y || low.z > high.z) extent.swapped = i;
    extent.plane = max(high.x - low.x, high.y - low.y);
    extent.size = max(extent.plane, high.z - low.z);
    extent.reach = max(reach(low), reach(high));
    extent.first = extent.last = low;
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
    both.first = {min(a.first.x, b.first.x), min(a.first.y, b.first.y), min(a.first.z, b.first.z)};
    both.last = {max(a.last.x, b.last.x), max(a.last.y, b.last.y), max(a.last.z, b.last.z)};
    both.infinite = Least{}(a.infinite, b.infinite);
    both.swapped = Least{}(a.swapped, b.swapped);
    both.unordered = Least{}(a.unordered, b.unordered);
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

}  // namespace breccia
