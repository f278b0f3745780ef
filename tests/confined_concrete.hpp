#pragma once
// Parameters of concrete that bound it under pressure (docs/theory.md, section 4).

#include "dem/setup/config.hpp"

namespace breccia::testing {

/// Concrete of 30 MPa; elasticity, density and the factors of moments stay as they are.
inline void confine(dem::MaterialConfig& m) {
  m.tensile_strength = 1.8e6;
  m.cohesion = 11e6;
  m.softening = 10.0;
  m.friction_angle = 10.0 / 180.0 * 3.14159265358979323846;
  m.broken_friction = 0.176;
  m.rolling_limit = 2.0;
  m.broken_rolling_limit = 0.05;
  m.rolling_cap = 2e6;
  m.slip_wear = 0.3;
  m.turn_wear = 0.1;
  m.compaction_strength = 60e6;
  m.compaction_slope = 0.4;
  m.crushing_strength = 10e6;
  m.crushing_slope = 0.4;
}

}  // namespace breccia::testing
