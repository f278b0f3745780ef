#pragma once
// The motion that travel is measured against.

#include "math/vec2.hpp"

namespace breccia::fdem {

/// A motion that all triangles are thought to share. Whether two of them touch depends on where
/// they are to each other: moving both back by the same way changes nothing. So travel since a
/// search (core/travel.hpp) may be measured after any common way is taken off; a body at rest then
/// travels backwards.
struct Drift {
  Vec2 velocity{};        ///<  [m/s]
  double since = 0.0;     ///< time of the search  [s]
  double farthest = 0.0;  ///< way for which rounding is covered  [m]

  BR_HD Vec2 way(double time) const { return (time - since) * velocity; }
};

}  // namespace breccia::fdem
