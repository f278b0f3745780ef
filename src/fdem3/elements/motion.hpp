#pragma once
// The motion of tetrahedra: fdem_shared/motion.hpp with their types.

#include "fdem3/elements/tetrahedra.hpp"
#include "fdem_shared/motion.hpp"

namespace breccia::fdem3 {

/// Prescribed motion of a tetrahedron's corners: bits 3 k, 3 k + 1, 3 k + 2 fix x, y, z of corner
/// k, whose motion is motion[k].
struct Hold {
  std::uint16_t fixed = 0;
  std::uint8_t gone = 0;   ///< 1: the tetrahedron has been taken out of the model
  std::uint8_t loose = 0;  ///< 1: forces move the rigid body that it is a part of
  std::int16_t motion[4] = {-1, -1, -1, -1};

  /// Bits 0, 1 and 2: x, y and z of corner k.
  BR_HD int fixed_at(int k) const { return fixed >> (3 * k) & 7; }
};
using Motion = fdem_shared::MotionNow<Vec3>;

struct MovingTetrahedron {
  static constexpr const char *word = "tetrahedron", *move = "fdem3.move";
  using Vector = Vec3;
  using Nodes = TetrahedronNodes;
  using Corners = fdem3::Corners;
  using Hold = fdem3::Hold;
  using Motion = fdem3::Motion;
};
using Kick = fdem_shared::KickOf<MovingTetrahedron>;
using TravelOfTetrahedra = fdem_shared::TravelOf<MovingTetrahedron>;
using MoveTetrahedra = fdem_shared::MoveOf<MovingTetrahedron>;

}  // namespace breccia::fdem3
