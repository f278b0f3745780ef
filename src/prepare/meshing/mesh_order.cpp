#include "prepare/meshing/mesh_order.hpp"

#include <algorithm>

#include "prepare/meshing/mesh.hpp"
#include "prepare/order.hpp"

namespace breccia::prepare {

std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y) {
  std::uint32_t index = 0;
  for (std::uint32_t s = 1U << 15; s > 0; s >>= 1) {
    const std::uint32_t right = (x & s) != 0 ? 1 : 0, up = (y & s) != 0 ? 1 : 0;
    index += s * s * ((3 * right) ^ up);
    if (up == 0) {  // the quarter's curve is turned
      if (right == 1) {
        x = 0xffffU - x;
        y = 0xffffU - y;
      }
      std::swap(x, y);
    }
  }
  return index;
}

void order_along_curve(fdem::Model& model) {
  if (model.point.empty()) return;
  Vec2 low = model.point[0], high = low;
  for (const Vec2& p : model.point) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double scale = 65535.0 / std::max({high.x - low.x, high.y - low.y, 1e-300});
  std::vector<std::pair<std::uint32_t, Index>> keys;
  keys.reserve(model.triangle.size());
  for (std::size_t t = 0; t < model.triangle.size(); ++t) {
    const Vec2 place = scale * (centroid(model.point, model.triangle[t]) - low);
    keys.emplace_back(
        hilbert_index(static_cast<std::uint32_t>(place.x), static_cast<std::uint32_t>(place.y)),
        static_cast<Index>(t));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> order;
  order.reserve(keys.size());
  for (const auto& [key, t] : keys) order.push_back(t);
  const std::vector<Index> number = reorder_mesh(model, model.triangle, order);
  const auto renumber = [&](std::array<Index, 2>& edge) {
    for (Index& v : edge) v = number[static_cast<std::size_t>(v)];
    if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
  };
  for (auto& set : model.edge_sets)
    for (auto& edge : set.edges) renumber(edge);
  for (auto& crack : model.discontinuities) renumber(crack.edge);
}

}  // namespace breccia::prepare
