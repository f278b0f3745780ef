#pragma once
// Which rank owns what: hierarchical recursive coordinate bisection on the load grid.

#include <array>
#include <cstdint>
#include <vector>

#include "domain/communicator.hpp"
#include "math/vec.hpp"

namespace breccia {

/// A place and what its element costs, in whole units: sums of them are exact in any order.
struct Load {
  Vec3 place;  ///<  [m]
  std::int64_t weight = 1;
};

/// The rectangles of the ranks: columns in x, each cut into rows in y, each cut into layers in z
/// (Lukas et al. 2014, sections 3.2 and 4; docs/theory-domain.md, section 1). Outer rectangles
/// reach to infinity.
///
/// Any number of ranks: columns and rows may hold different numbers of them, and are cut in
/// proportion. Who owns a place follows from the borders alone, on every rank alike.
class Partition {
 public:
  /// All places belong to rank 0.
  Partition() = default;
  /// @param extent  size of the model: decides how many columns, rows and layers there are  [m]
  /// @param cell    width d_LB of the load grid's cells: borders move in steps of it  [m]
  /// @param depth   2: columns and rows; 3: layers, too
  Partition(int ranks, const Vec3& origin, const Vec3& extent, double cell, int depth);

  /// Cuts anew, so that all ranks of `ranks` get about the same weight. Every rank calls it with
  /// its own loads. A border lies on the edge of a cell; the weight on either side of it misses its
  /// share by at most half the weight of the cells beside the border.
  void cut(Communicator& ranks, const std::vector<Load>& loads);

  int owner(const Vec3& place) const;
  /// Calls visit(rank) for each rank whose rectangle lies within `width` of the place, measured
  /// along the axes: the set P(e) of Lukas 2014, 3.1, of an element there.
  template <class Visit>
  void each_near(const Vec3& place, double width, const Visit& visit) const {
    each_part(0, place, width, 0, visit);
  }

  /// Moves all rectangles: with elements that fly together.
  void move(const Vec3& by) { origin_ += by; }

  int ranks() const { return ranks_; }
  /// The lower and upper border of a rank's rectangle along an axis; infinite at the rim.  [m]
  std::array<double, 2> borders(int rank, int axis) const;

 private:
  /// Parts side by side along an axis: part i holds `ranks[i]` ranks from rank `first[i]` on.
  struct Level {
    int axis = 0;
    std::vector<int> first;            ///< rank of each part, and the end
    std::vector<std::int64_t> border;  ///< cell where each part but the first begins
    std::vector<int> below;            ///< level that divides each part, -1: a single rank
  };

  int add_level(int first, int count, int axis, int depth, const Vec3& extent);
  std::int64_t cell_of(double coordinate, int axis) const;
  std::size_t part_of(const Level& level, const Vec3& place) const;
  double coordinate(std::int64_t border, int axis) const;

  template <class Visit>
  void each_part(int index, const Vec3& place, double width, int rank, const Visit& visit) const {
    if (index < 0 || levels_.empty()) return visit(rank);
    const Level& level = levels_[static_cast<std::size_t>(index)];
    const double x = level.axis == 0 ? place.x : level.axis == 1 ? place.y : place.z;
    for (std::size_t part = 0; part + 1 < level.first.size(); ++part) {
      if (part > 0 && x < coordinate(level.border[part - 1], level.axis) - width) break;
      if (part < level.border.size() && x > coordinate(level.border[part], level.axis) + width)
        continue;
      each_part(level.below[part], place, width, level.first[part], visit);
    }
  }

  int ranks_ = 1;
  Vec3 origin_{};
  double cell_ = 1.0;
  std::vector<Level> levels_;  ///< level 0 divides all
};

/// Largest load of a rank over the mean of all, less one. Every rank calls it with its own.
double imbalance(Communicator& ranks, std::int64_t load);

}  // namespace breccia
