#pragma once
// A uniform grid of cells over points: which points are in a box, in a fixed order.

#include <algorithm>
#include <span>

#include "exec/buffer.hpp"
#include "math/vec.hpp"

namespace breccia::prepare {

/// Points sorted by cell, z fastest, points of a cell in ascending index.
/// Memory: at most about eight cells a point, whatever the extent.
class CellGrid {
 public:
  /// @param edge  wanted edge length of a cell, > 0; larger when the points are far apart  [m]
  CellGrid(std::span<const Vec3> points, double edge, int threads = 1);

  /// Indices of the points in the order of the cells.
  std::span<const Index> order() const { return items_.host(); }

  /// visit(index) for every point in cells that the box around `center` meets: all points within
  /// `reach` in each direction, and some more.
  template <class Visit>
  void visit(const Vec3& center, double reach, Visit&& visit) const {
    const int x0 = cell(center.x - reach - low_.x, size_[0]);
    const int x1 = cell(center.x + reach - low_.x, size_[0]);
    const int y0 = cell(center.y - reach - low_.y, size_[1]);
    const int y1 = cell(center.y + reach - low_.y, size_[1]);
    const int z0 = cell(center.z - reach - low_.z, size_[2]);
    const int z1 = cell(center.z + reach - low_.z, size_[2]);
    for (int x = x0; x <= x1; ++x) {
      for (int y = y0; y <= y1; ++y) {
        const Index row = (x * size_[1] + y) * size_[2];
        const Index end = start_.data()[row + z1 + 1];
        for (Index k = start_.data()[row + z0]; k < end; ++k) visit(items_.data()[k]);
      }
    }
  }

 private:
  /// Cell of a coordinate along one axis; coordinates outside belong to the outermost cells.
  int cell(double offset, int size) const {
    const double c = offset * inverse_edge_;
    return c <= 0.0 ? 0 : c >= size - 1 ? size - 1 : static_cast<int>(c);
  }

  Vec3 low_{};
  double inverse_edge_ = 1.0;
  int size_[3] = {1, 1, 1};
  Buffer<Index> start_, items_;
};

}  // namespace breccia::prepare
