#pragma once
// A source of fluid that may be the gas of an explosive in holes.

#include <vector>

#include "fdem_shared/fluid/given.hpp"
#include "fdem_shared/laws/explosive.hpp"

namespace breccia::fdem_shared {

/// A side of the wall of a hole at the start.
template <class Vector, int corners>
struct WallSide {
  Index side;          ///< of the whole mesh  [-]
  Vector at[corners];  ///<  [m]
};

/// @tparam Side  that bears a load  @tparam Hole  its wall, as a method's sides make it
template <class Side, class Hole, class Vector, int corners>
struct GasSourceOf : FluidSource {
  /// Of an explosive: the walls of its holes, and what bears its pressure there; else empty.
  std::vector<Hole> holes{};
  std::vector<Side> borders{};
  ExplosiveGas law{};
  double charge = 0.0;  ///< volume of the explosive, in the plane per thickness  [m3; in 2D m2]
  std::vector<WallSide<Vector, corners>> start{};  ///< sides of its holes
};

/// Whether a case has explosives.
template <class World>
bool has_gas(const World& w) {
  for (const auto& source : w.given->fluids)
    if (!source.holes.empty()) return true;
  return false;
}

}  // namespace breccia::fdem_shared
