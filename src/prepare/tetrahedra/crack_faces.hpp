#pragma once
// Faces of a mesh along flat discs and polygons.

#include <functional>
#include <vector>

#include "fdem3/setup/body_config.hpp"
#include "prepare/tetrahedra/tet_check.hpp"

namespace breccia::prepare {

/// A flat disc or polygon.
class FlatCrack {
 public:
  explicit FlatCrack(const fdem3::DiscontinuityConfig& given);

  double height(const Vec3& x) const { return dot(x - place_, normal_); }  ///< above its plane  [m]
  /// Whether a point's foot on the plane lies in it.
  bool covers(const Vec3& x) const;

 private:
  Vec3 place_, normal_, across_, up_;
  double radius_ = 0.0;        ///< of a disc  [m]
  std::vector<Vec2> corners_;  ///< of a polygon, in the plane  [m]
};

/// Faces between two tetrahedra along a crack, sorted, each once.
///
/// Where the mesh was made to follow the crack: faces whose three corners lie on it. Elsewhere, in
/// each connected region of the mesh near it, the faces that part the region most cheaply: with the
/// mean edge h, a face costs its area times 0.05 + 2 d / h, at most 1, for the mean distance d of
/// its corners from the crack; a tetrahedron that ends on the wrong side costs 4 V d / h^2 for the
/// distance d of its centroid, or all there is if d > h. So the surface has no holes, keeps to
/// within an edge of the crack, and is as smooth as the mesh allows. It ends where the crack ends.
///
/// @param faces    of the tetrahedra
/// @param follows  whether a tetrahedron's mesh was made to follow the crack
std::vector<Face> faces_along(const fdem3::DiscontinuityConfig& crack,
                              const std::vector<Vec3>& point,
                              const std::vector<Tetrahedron>& tetrahedra,
                              const std::vector<MeshFace>& faces,
                              const std::function<bool(Index)>& follows);

}  // namespace breccia::prepare
