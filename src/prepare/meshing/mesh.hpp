#pragma once
// A mesh of triangles with named parts, on its way into a model.

#include <array>
#include <string>
#include <vector>

#include "exec/types.hpp"
#include "math/vec2.hpp"

namespace breccia::prepare {

using Triangle = std::array<Index, 3>;
using Edge = std::array<Index, 2>;

struct EdgeSet {
  std::string name;
  std::vector<Edge> edges;  ///< pairs of vertices
};

/// A group of triangles with a name; triangles may be in several parts.
struct Part {
  std::string name;
  std::vector<Index> triangles;
};

struct Mesh {
  std::vector<Vec2> point;         ///<  [m]
  std::vector<Triangle> triangle;  ///< corners, counter-clockwise
  std::vector<Part> parts;         ///< of a file; may be none
  std::vector<EdgeSet> edge_sets;  ///< of a file; may be none
  std::vector<Edge> inner{};       ///< of quadrangles: their triangles move as one across these
};

inline const Vec2& at(const std::vector<Vec2>& point, Index i) {
  return point[static_cast<std::size_t>(i)];
}
/// Positive if the corners are counter-clockwise.  [m2]
inline double signed_area(const std::vector<Vec2>& point, const Triangle& t) {
  const Vec2 a = at(point, t[0]);
  return 0.5 * cross(at(point, t[1]) - a, at(point, t[2]) - a);
}
inline Vec2 centroid(const std::vector<Vec2>& point, const Triangle& t) {
  return (1.0 / 3.0) * (at(point, t[0]) + at(point, t[1]) + at(point, t[2]));
}

}  // namespace breccia::prepare
