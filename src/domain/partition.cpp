#include "domain/partition.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace breccia {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double component(const Vec3& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// Parts along an axis for `count` ranks, so that rectangles come out about as wide as long.
int parts_along(int axis, int depth, int count, const Vec3& extent) {
  if (axis + 1 == depth) return count;
  const double least = 1e-9 * (extent.x + extent.y + extent.z) + 1e-300;
  const double x = std::max(extent.x, least), y = std::max(extent.y, least);
  const double z = std::max(extent.z, least);
  const double wanted = depth == 2  ? std::sqrt(count * x / y)
                        : axis == 0 ? std::cbrt(count * x * x / (y * z))
                                    : std::sqrt(count * y / z);
  return static_cast<int>(std::lround(std::clamp(wanted, 1.0, static_cast<double>(count))));
}

/// Cells of one axis that weights are counted in: [low, low + count) in strides of 2^shift cells.
struct Counted {
  std::int64_t low = 0;
  int shift = 0;
  std::size_t count = 0;
};

/// Where to cut: border j is the stride's edge next to the share of the parts before it.
std::vector<std::int64_t> borders_of(const std::int64_t* weight, const Counted& cells,
                                     const std::vector<int>& first) {
  std::int64_t total = 0;
  for (std::size_t c = 0; c < cells.count; ++c) total += weight[c];
  const std::int64_t ranks = first.back() - first.front();
  std::vector<std::int64_t> border;
  std::size_t c = 0;
  std::int64_t before = 0;  // weight of the strides below c
  for (std::size_t part = 1; part + 1 < first.size(); ++part) {
    const std::int64_t wanted = total * (first[part] - first.front());
    while (c < cells.count && before * ranks < wanted) before += weight[c++];
    const bool nearer_below =
        c > 0 && wanted - (before - weight[c - 1]) * ranks <= before * ranks - wanted;
    const std::size_t at = nearer_below ? c - 1 : c;
    std::int64_t cell = cells.low + (static_cast<std::int64_t>(at) << cells.shift);
    if (!border.empty()) cell = std::max(cell, border.back());
    border.push_back(cell);
  }
  return border;
}

}  // namespace

Partition::Partition(int ranks, const Vec3& origin, const Vec3& extent, double cell, int depth)
    : ranks_(ranks), origin_(origin), cell_(cell) {
  if (ranks > 1) add_level(0, ranks, 0, depth, extent);
}

int Partition::add_level(int first, int count, int axis, int depth, const Vec3& extent) {
  if (count == 1) return -1;
  const auto index = static_cast<int>(levels_.size());
  levels_.emplace_back();
  Level level;
  level.axis = axis;
  const int parts = parts_along(axis, depth, count, extent);
  for (int part = 0; part <= parts; ++part) level.first.push_back(first + count * part / parts);
  level.border.assign(static_cast<std::size_t>(parts) - 1, 0);
  const Vec3 inside{axis == 0 ? extent.x / parts : extent.x,
                    axis == 1 ? extent.y / parts : extent.y, extent.z};
  for (int part = 0; part < parts; ++part) {
    const auto p = static_cast<std::size_t>(part);
    level.below.push_back(
        add_level(level.first[p], level.first[p + 1] - level.first[p], axis + 1, depth, inside));
  }
  levels_[static_cast<std::size_t>(index)] = std::move(level);
  return index;
}

std::int64_t Partition::cell_of(double coordinate, int axis) const {
  constexpr double most = 9e15;  // what is nowhere (NaN) or further out belongs to the rim
  const double cell = std::floor((coordinate - component(origin_, axis)) / cell_);
  return cell > -most ? static_cast<std::int64_t>(std::min(cell, most))
                      : static_cast<std::int64_t>(-most);
}

double Partition::coordinate(std::int64_t border, int axis) const {
  return component(origin_, axis) + static_cast<double>(border) * cell_;
}

std::size_t Partition::part_of(const Level& level, const Vec3& place) const {
  const std::int64_t cell = cell_of(component(place, level.axis), level.axis);
  return static_cast<std::size_t>(std::upper_bound(level.border.begin(), level.border.end(), cell) -
                                  level.border.begin());
}

int Partition::owner(const Vec3& place) const {
  int rank = 0;
  for (int index = levels_.empty() ? -1 : 0; index >= 0;) {
    const Level& level = levels_[static_cast<std::size_t>(index)];
    const std::size_t part = part_of(level, place);
    rank = level.first[part];
    index = level.below[part];
  }
  return rank;
}

void Partition::cut(Communicator& ranks, const std::vector<Load>& loads) {
  constexpr std::int64_t most_strides = 1 << 14;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::size_t> here;  // levels of this axis
    std::vector<int> slot(levels_.size(), -1);
    for (std::size_t i = 0; i < levels_.size(); ++i)
      if (levels_[i].axis == axis) {
        slot[i] = static_cast<int>(here.size());
        here.push_back(i);
      }
    if (here.empty()) return;

    double low = infinity, minus_high = infinity;
    for (const Load& load : loads) {
      const auto cell = static_cast<double>(cell_of(component(load.place, axis), axis));
      low = std::min(low, cell);
      minus_high = std::min(minus_high, -cell);
    }
    low = ranks.least(low);
    minus_high = ranks.least(minus_high);
    if (!(low < infinity)) return;  // there is nothing to share out
    Counted cells;
    cells.low = static_cast<std::int64_t>(low);
    const std::int64_t span = static_cast<std::int64_t>(-minus_high) - cells.low + 1;
    while ((span >> cells.shift) >= most_strides) ++cells.shift;
    // Strides begin at the same cells whatever the lowest is, so that borders move little.
    cells.low = (cells.low >> cells.shift) << cells.shift;
    const std::int64_t high = static_cast<std::int64_t>(-minus_high);
    cells.count = static_cast<std::size_t>(((high - cells.low) >> cells.shift) + 1);

    std::vector<std::int64_t> weight(cells.count * here.size(), 0);
    for (const Load& load : loads) {
      std::size_t index = 0;
      int down = 0;
      while (down >= 0 && levels_[static_cast<std::size_t>(down)].axis < axis) {
        const Level& level = levels_[static_cast<std::size_t>(down)];
        down = level.below[part_of(level, load.place)];
      }
      if (down < 0) continue;  // a single rank: nothing more to cut
      index = static_cast<std::size_t>(slot[static_cast<std::size_t>(down)]);
      const std::int64_t cell = cell_of(component(load.place, axis), axis) - cells.low;
      weight[index * cells.count + static_cast<std::size_t>(cell >> cells.shift)] += load.weight;
    }
    ranks.add_up(weight);
    for (std::size_t i = 0; i < here.size(); ++i)
      levels_[here[i]].border =
          borders_of(weight.data() + i * cells.count, cells, levels_[here[i]].first);
  }
}

std::array<double, 2> Partition::borders(int rank, int axis) const {
  std::array<double, 2> found{-infinity, infinity};
  for (int index = levels_.empty() ? -1 : 0; index >= 0;) {
    const Level& level = levels_[static_cast<std::size_t>(index)];
    std::size_t part = 0;
    while (level.first[part + 1] <= rank) ++part;
    if (level.axis == axis) {
      if (part > 0) found[0] = coordinate(level.border[part - 1], axis);
      if (part < level.border.size()) found[1] = coordinate(level.border[part], axis);
    }
    index = level.below[part];
  }
  return found;
}

double imbalance(Communicator& ranks, std::int64_t load) {
  std::int64_t total = load;
  ranks.add_up(std::span<std::int64_t>(&total, 1));
  const double largest = -ranks.least(-static_cast<double>(load));
  return total > 0 ? largest * ranks.size() / static_cast<double>(total) - 1.0 : 0.0;
}

}  // namespace breccia
