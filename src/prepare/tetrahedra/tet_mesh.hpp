#pragma once
// A mesh of tetrahedra with named parts, on its way into a model.

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "exec/types.hpp"
#include "math/vec.hpp"

namespace breccia::prepare {

using Tetrahedron = std::array<Index, 4>;
using Face = std::array<Index, 3>;

struct FaceSet {
  std::string name;
  std::vector<Face> faces;  ///< vertices, ascending
};

/// A group of tetrahedra with a name; tetrahedra may be in several.
struct Volume {
  std::string name;
  std::vector<Index> tetrahedra;
};

struct TetMesh {
  std::vector<Vec3> point;               ///<  [m]
  std::vector<Tetrahedron> tetrahedron;  ///< corners, of positive volume
  std::vector<Volume> volumes;           ///< of a file; may be none
  std::vector<FaceSet> face_sets;        ///< of a file; may be none
};

/// Corners of a face, opposite the corner of its number; they run counter-clockwise seen from
/// outside.
inline constexpr std::array<std::array<std::size_t, 3>, 4> face_corners{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

using breccia::at;  // of an index alone
inline const Vec3& at(const std::vector<Vec3>& point, Index i) {
  return point[static_cast<std::size_t>(i)];
}
/// det(x1 - x0, x2 - x0, x3 - x0) / 6.  [m3]
inline double signed_volume(const std::vector<Vec3>& point, const Tetrahedron& t) {
  const Vec3 a = at(point, t[0]);
  return dot(cross(at(point, t[1]) - a, at(point, t[2]) - a), at(point, t[3]) - a) / 6.0;
}
inline Vec3 centroid(const std::vector<Vec3>& point, const Tetrahedron& t) {
  return 0.25 * (at(point, t[0]) + at(point, t[1]) + at(point, t[2]) + at(point, t[3]));
}
inline Vec3 centroid(const std::vector<Vec3>& point, const Face& f) {
  return (1.0 / 3.0) * (at(point, f[0]) + at(point, f[1]) + at(point, f[2]));
}
inline Face sorted(Face face) {
  if (face[0] > face[1]) std::swap(face[0], face[1]);
  if (face[1] > face[2]) std::swap(face[1], face[2]);
  if (face[0] > face[1]) std::swap(face[0], face[1]);
  return face;
}
inline Face face_of(const Tetrahedron& t, std::size_t k) {
  return {t[face_corners[k][0]], t[face_corners[k][1]], t[face_corners[k][2]]};
}

}  // namespace breccia::prepare
