#include "prepare/packing/ordering.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include "dem/setup/model_arrays.hpp"
#include "exec/filling.hpp"
#include "exec/sort_scan.hpp"
#include "prepare/order.hpp"

namespace breccia::prepare {
namespace {

std::array<double, 3> components(const Vec3& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

PlainVector<Index> spatial_order(std::span<const Vec3> position, double edge, int threads) {
  const auto count = static_cast<Index>(position.size());
  struct Bounds {
    std::array<double, 3> low{no_limit, no_limit, no_limit}, high{-no_limit, -no_limit, -no_limit};
  };
  Bounds all;
  const auto widen = [](Bounds& bounds, const Bounds& by) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bounds.low[axis] = std::min(bounds.low[axis], by.low[axis]);
      bounds.high[axis] = std::max(bounds.high[axis], by.high[axis]);
    }
  };
  for (const auto& run : of_runs(threads, count, [&](Index begin, Index end) {
         Bounds own;
         for (Index i = begin; i < end; ++i)
           widen(own, {components(position[at(i)]), components(position[at(i)])});
         return own;
       }))
    widen(all, run.found);
  std::array<double, 3> extent{};
  for (std::size_t axis = 0; axis < 3 && count > 0; ++axis)
    extent[axis] = all.high[axis] - all.low[axis];
  std::array<std::size_t, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(),
                   [&](std::size_t a, std::size_t b) { return extent[a] > extent[b]; });
  const auto cells_of = [&](Index i) {
    const auto p = components(position[at(i)]);
    std::array<double, 3> cells{};
    for (std::size_t k = 0; k < 3; ++k)
      cells[k] = std::floor((p[axes[k]] - all.low[axes[k]]) / edge);
    return cells;
  };

  PlainVector<Index> order;
  order.resize(position.size());
  int bits = 0;  // of a cell's numbers, one after the other
  std::array<int, 3> width{};
  for (std::size_t k = 0; k < 3; ++k) {
    constexpr double countable = 1e18;
    const double last = std::floor(extent[axes[k]] / edge);
    width[k] =
        last < countable ? static_cast<int>(std::bit_width(static_cast<std::uint64_t>(last))) : 64;
    bits += width[k];
  }
  if (bits < 64) {
    Buffer<KeyedIndex> keys;
    fill_items(keys, count, threads, [&](Index i) {
      const auto cells = cells_of(i);
      std::uint64_t key = 0;
      for (std::size_t k = 0; k < 3; ++k)
        key = (key << width[k]) | static_cast<std::uint64_t>(cells[k]);
      return KeyedIndex{key, i};
    });
    sort_by_key({.threads = threads}, keys);
    each_portion(threads, count, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) order[at(i)] = keys.data()[i].item;
    });
    return order;
  }
  using Key = std::tuple<std::array<double, 3>, Index>;  // cells that are far apart
  std::vector<Key> keys;
  keys.reserve(position.size());
  for (Index i = 0; i < count; ++i) keys.emplace_back(cells_of(i), i);
  std::sort(keys.begin(), keys.end());
  for (Index i = 0; i < count; ++i) order[at(i)] = std::get<Index>(keys[at(i)]);
  return order;
}

void reorder(dem::Model& model, const PlainVector<Index>& order, int threads) {
  BR_ASSERT(model.links.empty());
  each_element_array(model, [&](const char*, auto& items) { permute(items, order, threads); });
  PlainVector<Index> rank;
  rank.resize(order.size());
  each_portion(threads, static_cast<Index>(order.size()), [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) rank[at(order[at(k)])] = k;
  });
  const auto renumber = [&](Index& element) {
    if (element >= 0) element = rank[at(element)];
  };
  each_portion(threads, static_cast<Index>(model.facets.size()), [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      dem::Model::Facet& facet = model.facets[at(k)];
      for (Index* corner : {&facet.a, &facet.b, &facet.c, &facet.d}) renumber(*corner);
    }
  });
  each_portion(threads, model.size(), [&](Index begin, Index end) {
    for (Index e = begin; e < end; ++e) {
      renumber(model.bar_previous[at(e)]);
      renumber(model.bar_next[at(e)]);
    }
  });
}

}  // namespace breccia::prepare
