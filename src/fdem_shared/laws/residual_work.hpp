#pragma once
// Work of the friction that joints keep while they soften.

#include "math/pack.hpp"

namespace breccia::fdem_shared {

/// Of what a joint that is no longer whole has spent by sliding, what residual friction took.
/// [J; in 2D J/m]
/// @param work  of residual friction  @param held  of it, by springs of the joint or of contact
BR_HD inline double spent_on_friction(double work, double held, double slide) {
  return work > 0.0 ? max(0.0, min(work - held, slide)) : 0.0;
}

}  // namespace breccia::fdem_shared
