#include "fdem3/setup/flatness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "math/vec.hpp"

namespace breccia::fdem3 {
namespace {

/// The least height over a face.  [m]
double least_height(const Vec3 (&x)[4]) {
  const double six_volumes = dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0]));
  double largest = 0.0;  // twice the area of a face
  for (int k = 0; k < 4; ++k) {
    const Vec3 &p = x[(k + 1) % 4], &q = x[(k + 2) % 4], &r = x[(k + 3) % 4];
    largest = std::max(largest, norm(cross(q - p, r - p)));
  }
  return largest > 0.0 ? six_volumes / largest : 0.0;
}

}  // namespace

std::optional<std::string> flat_tetrahedron(const Model& model) {
  constexpr double much = 0.1;  // of the median
  std::vector<double> heights;
  heights.reserve(model.tetrahedron.size());
  for (const auto& corners : model.tetrahedron) {
    Vec3 x[4];
    for (std::size_t k = 0; k < 4; ++k) x[k] = model.point[static_cast<std::size_t>(corners[k])];
    heights.push_back(least_height(x));
  }
  if (heights.empty()) return {};
  const auto least = std::min_element(heights.begin(), heights.end());
  const auto number = least - heights.begin();
  const double height = *least;
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  if (!(height < much * *middle)) return {};
  const auto group = static_cast<std::size_t>(model.group[static_cast<std::size_t>(number)]);
  return fmt::format(
      "tetrahedron {} ({}) is {:.2g} m high, the median {:.2g} m: it alone makes the time step "
      "shorter, and steps so many more. A mesh_size that differs by a few per cent often has none "
      "like it",
      number, model.groups.at(group), height, *middle);
}

}  // namespace breccia::fdem3
