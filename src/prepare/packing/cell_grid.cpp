#include "prepare/packing/cell_grid.hpp"

#include "core/rows.hpp"
#include "exec/filling.hpp"
#include "exec/sort_scan.hpp"

namespace breccia::prepare {
namespace {

struct Spread {
  Vec3 low, high;

  void widen(const Spread& by) {
    low = {std::min(low.x, by.low.x), std::min(low.y, by.low.y), std::min(low.z, by.low.z)};
    high = {std::max(high.x, by.high.x), std::max(high.y, by.high.y), std::max(high.z, by.high.z)};
  }
};

}  // namespace

CellGrid::CellGrid(std::span<const Vec3> points, double edge, int threads) {
  const FillingThreads filling(threads);
  const auto count = static_cast<Index>(points.size());
  if (count == 0) {
    start_.resize(2);
    return;
  }
  Spread all{points[0], points[0]};
  for (const auto& run : of_runs(threads, count, [&](Index begin, Index end) {
         Spread own{points[at(begin)], points[at(begin)]};
         for (Index i = begin; i < end; ++i) own.widen({points[at(i)], points[at(i)]});
         return own;
       }))
    all.widen(run.found);
  low_ = all.low;
  const Vec3 extent = all.high - low_;
  const double most = 8.0 * static_cast<double>(count) + 64.0;
  while ((extent.x / edge + 1.0) * (extent.y / edge + 1.0) * (extent.z / edge + 1.0) > most)
    edge *= 1.25;
  inverse_edge_ = 1.0 / edge;
  size_[0] = static_cast<int>(extent.x * inverse_edge_) + 1;
  size_[1] = static_cast<int>(extent.y * inverse_edge_) + 1;
  size_[2] = static_cast<int>(extent.z * inverse_edge_) + 1;

  const auto cell_of = [&](Index i) {
    const Vec3 offset = points[at(i)] - low_;
    return (cell(offset.x, size_[0]) * size_[1] + cell(offset.y, size_[1])) * size_[2] +
           cell(offset.z, size_[2]);
  };
  const Index cells = size_[0] * size_[1] * size_[2];
  start_.resize(cells + 1);
  each_portion(threads, count, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) count_up(start_.data()[cell_of(i)]);
  });
  exclusive_scan({.threads = threads}, start_);
  items_.resize_unfilled(count);
  Buffer<Index> next(start_);
  each_portion(threads, count, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) items_.data()[count_up(next.data()[cell_of(i)])] = i;
  });
  if (threads <= 1) return;  // each cell's ascend already
  each_portion(threads, cells, [&](Index begin, Index end) {
    for (Index c = begin; c < end; ++c)
      sort_row(items_.data() + start_.data()[c], start_.data()[c + 1] - start_.data()[c],
               [](Index p, Index q) { return p < q; });
  });
}

}  // namespace breccia::prepare
