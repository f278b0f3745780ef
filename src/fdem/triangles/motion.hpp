#pragma once
// The motion of triangles: fdem_shared/motion.hpp with their types.

#include "fdem/triangles/triangles.hpp"
#include "fdem_shared/motion.hpp"

namespace breccia::fdem {

using fdem_shared::Columns;
using fdem_shared::Moved;

/// Prescribed motion of a triangle's corners: bits 2 k and 2 k + 1 fix x and y of corner k, whose
/// motion is motion[k].
struct Hold {
  std::uint8_t fixed = 0;
  std::uint8_t gone = 0;   ///< 1: the triangle has been taken out of the model
  std::uint8_t loose = 0;  ///< 1: forces move the rigid body that it is a part of
  std::int16_t motion[3] = {-1, -1, -1};

  /// Bits 0 and 1: x and y of corner k.
  BR_HD int fixed_at(int k) const { return fixed >> (2 * k) & 3; }
};
/// @param hold  of a triangle
BR_HD inline bool is_gone(const View<const Hold>& holds, Index hold) {
  return hold >= 0 && holds[hold].gone != 0;
}
using Motion = fdem_shared::MotionNow<Vec2>;

struct MovingTriangle {
  static constexpr const char *word = "triangle", *move = "fdem.move";
  using Vector = Vec2;
  using Nodes = TriangleNodes;
  using Corners = fdem::Corners;
  using Hold = fdem::Hold;
  using Motion = fdem::Motion;
};
using Kick = fdem_shared::KickOf<MovingTriangle>;
using TravelOfTriangles = fdem_shared::TravelOf<MovingTriangle>;
using MoveTriangles = fdem_shared::MoveOf<MovingTriangle>;

}  // namespace breccia::fdem
