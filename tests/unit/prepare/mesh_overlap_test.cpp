// Triangles of a mesh that share area.

#include "prepare/meshing/mesh_overlap.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace breccia {
namespace mesh_overlap_test {

std::size_t found(const std::vector<Vec2>& point, const std::vector<prepare::Triangle>& triangles) {
  return prepare::overlaps_of(point, triangles).size();
}

/// Turned and moved, so that no edge lies along an axis.
std::vector<Vec2> moved(std::vector<Vec2> points, double angle) {
  for (Vec2& p : points)
    p = {3.0 + std::cos(angle) * p.x - std::sin(angle) * p.y,
         -7.0 + std::sin(angle) * p.x + std::cos(angle) * p.y};
  return points;
}

TEST(MeshOverlap, of_two_that_share_a_vertex) {
  for (const double angle : {0.0, 0.3, 2.0, 4.0}) {
    const std::vector<Vec2> p =
        moved({{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}, {0.5, 0.2}, {0.2, 0.5}, {-1.0, 0.4}},
              angle);
    EXPECT_EQ(found(p, {{0, 1, 2}, {0, 2, 3}}), 0U) << "neighbours";
    EXPECT_EQ(found(p, {{0, 1, 2}, {0, 3, 6}}), 0U) << "a corner in common";
    EXPECT_EQ(found(p, {{0, 1, 2}, {0, 4, 3}}), 1U) << "a corner of one inside the other";
    EXPECT_EQ(found(p, {{0, 1, 3}, {1, 2, 5}}), 1U);
    EXPECT_EQ(found(p, {{0, 4, 5}, {0, 1, 3}}), 1U) << "one inside the other";
    EXPECT_EQ(found(p, {{0, 1, 3}, {0, 1, 2}}), 1U) << "on the same side of an edge";
    EXPECT_EQ(found(p, {{0, 1, 3}, {1, 3, 0}}), 1U) << "twice the same";
  }
}

/// Fans of triangles around a vertex lie apart, however thin.
TEST(MeshOverlap, of_a_fan_is_nothing) {
  for (const int blades : {3, 7, 60}) {
    const Random random{static_cast<std::uint64_t>(blades), 1};
    std::vector<Vec2> point{{0.1, 0.2}};
    std::vector<prepare::Triangle> fan;
    for (int k = 0; k < blades; ++k) {
      const double angle = 6.283185307179586 * k / blades;
      const double radius = 0.5 + random.uniform(static_cast<std::uint64_t>(k));
      point.push_back({0.1 + radius * std::cos(angle), 0.2 + radius * std::sin(angle)});
      fan.push_back({0, 1 + k, 1 + (k + 1) % blades});
    }
    EXPECT_EQ(found(point, fan), 0U) << blades;
  }
}

}  // namespace mesh_overlap_test
}  // namespace breccia
