#include "prepare/packing/cell_grid.hpp"

namespace breccia::prepare {

CellGrid::CellGrid(const std::vector<Vec3>& points, double edge) {
  const std::size_t count = points.size();
  if (count == 0) {
    start_.assign(2, 0);
    return;
  }
  low_ = points[0];
  Vec3 high = points[0];
  for (const Vec3& p : points) {
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 extent = high - low_;
  const double most = 8.0 * static_cast<double>(count) + 64.0;
  while ((extent.x / edge + 1.0) * (extent.y / edge + 1.0) * (extent.z / edge + 1.0) > most)
    edge *= 1.25;
  inverse_edge_ = 1.0 / edge;
  size_[0] = static_cast<int>(extent.x * inverse_edge_) + 1;
  size_[1] = static_cast<int>(extent.y * inverse_edge_) + 1;
  size_[2] = static_cast<int>(extent.z * inverse_edge_) + 1;

  const auto cell_count = static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                          static_cast<std::size_t>(size_[2]);
  std::vector<Index> key(count);
  start_.assign(cell_count + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 offset = points[i] - low_;
    key[i] = (cell(offset.x, size_[0]) * size_[1] + cell(offset.y, size_[1])) * size_[2] +
             cell(offset.z, size_[2]);
    ++start_[static_cast<std::size_t>(key[i]) + 1];
  }
  for (std::size_t c = 0; c < cell_count; ++c) start_[c + 1] += start_[c];
  items_.resize(count);
  std::vector<Index> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < count; ++i) {
    Index& slot = next[static_cast<std::size_t>(key[i])];
    items_[static_cast<std::size_t>(slot++)] = static_cast<Index>(i);
  }
}

}  // namespace breccia::prepare
