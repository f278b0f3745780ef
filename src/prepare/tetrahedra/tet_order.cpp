#include "prepare/tetrahedra/tet_order.hpp"

#include <algorithm>

#include "prepare/order.hpp"
#include "prepare/tetrahedra/tet_mesh.hpp"

namespace breccia::prepare {
namespace {

constexpr int curve_bits = 21;

std::vector<Index> curve_order(const fdem3::Model& model) {
  Vec3 low = model.point[0], high = low;
  for (const Vec3& p : model.point) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const double scale = ((1 << curve_bits) - 1.0) /
                       std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-300});
  std::vector<std::pair<std::uint64_t, Index>> keys;
  keys.reserve(model.tetrahedron.size());
  for (std::size_t t = 0; t < model.tetrahedron.size(); ++t) {
    const Vec3 place = scale * (centroid(model.point, model.tetrahedron[t]) - low);
    keys.emplace_back(
        hilbert_index(static_cast<std::uint32_t>(place.x), static_cast<std::uint32_t>(place.y),
                      static_cast<std::uint32_t>(place.z)),
        static_cast<Index>(t));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> order;
  order.reserve(keys.size());
  for (const auto& [key, t] : keys) order.push_back(t);
  return order;
}

}  // namespace

std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::array<std::uint32_t, 3> axis{x, y, z};
  for (std::uint32_t bit = 1U << (curve_bits - 1); bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::uint32_t& a : axis) {
      if ((a & bit) != 0) {
        axis[0] ^= below;  // turned round
      } else {
        const std::uint32_t change = (axis[0] ^ a) & below;  // axes exchanged
        axis[0] ^= change;
        a ^= change;
      }
    }
  }
  axis[1] ^= axis[0];
  axis[2] ^= axis[1];
  std::uint32_t flips = 0;
  for (std::uint32_t bit = 1U << (curve_bits - 1); bit > 1; bit >>= 1)
    if ((axis[2] & bit) != 0) flips ^= bit - 1;
  std::uint64_t index = 0;
  for (int b = curve_bits - 1; b >= 0; --b)
    for (const std::uint32_t a : axis) index = (index << 1) | (((a ^ flips) >> b) & 1U);
  return index;
}

void order_along_curve(fdem3::Model& model) {
  if (model.point.empty()) return;
  const std::vector<Index> order = curve_order(model);
  const std::vector<Index> number = reorder_mesh(model, model.tetrahedron, order);
  const auto renumber = [&](Face& face) {
    for (Index& v : face) v = number[static_cast<std::size_t>(v)];
    face = sorted(face);
  };
  for (auto& set : model.face_sets)
    for (auto& face : set.faces) renumber(face);
  for (auto& crack : model.discontinuities) renumber(crack.face);
}

}  // namespace breccia::prepare
