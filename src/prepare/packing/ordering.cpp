#include "prepare/packing/ordering.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "dem/setup/model_arrays.hpp"
#include "exec/types.hpp"
#include "prepare/order.hpp"

namespace breccia::prepare {
namespace {

std::array<double, 3> components(const Vec3& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

std::vector<Index> spatial_order(const std::vector<Vec3>& position, double edge) {
  std::array<double, 3> low{}, extent{};
  for (std::size_t axis = 0; axis < 3 && !position.empty(); ++axis) {
    const auto [least, most] = std::minmax_element(
        position.begin(), position.end(),
        [axis](const Vec3& a, const Vec3& b) { return components(a)[axis] < components(b)[axis]; });
    low[axis] = components(*least)[axis];
    extent[axis] = components(*most)[axis] - low[axis];
  }
  std::array<std::size_t, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(),
                   [&](std::size_t a, std::size_t b) { return extent[a] > extent[b]; });

  using Key = std::tuple<double, double, double, Index>;
  std::vector<Key> keys;
  keys.reserve(position.size());
  for (std::size_t i = 0; i < position.size(); ++i) {
    const auto p = components(position[i]);
    const auto cell = [&](std::size_t axis) { return std::floor((p[axis] - low[axis]) / edge); };
    keys.emplace_back(cell(axes[0]), cell(axes[1]), cell(axes[2]), static_cast<Index>(i));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> order;
  order.reserve(keys.size());
  for (const Key& key : keys) order.push_back(std::get<3>(key));
  return order;
}

void reorder(dem::Model& model, const std::vector<Index>& order) {
  BR_ASSERT(model.links.empty());
  each_element_array(model, [&](const char*, auto& items) { permute(items, order); });
  std::vector<Index> rank(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    rank[static_cast<std::size_t>(order[k])] = static_cast<Index>(k);
  each_element_number(model, [&](Index& element, int) {
    if (element >= 0) element = rank[static_cast<std::size_t>(element)];
  });
}

}  // namespace breccia::prepare
