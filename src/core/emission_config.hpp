#pragma once
// [emission]: which breaks are one event of acoustic emission.

#include "core/keys.hpp"

namespace breccia {

struct EmissionConfig {
  double distance = 0.0;  ///< 0: two mean edges, or diameters of elements  [m]
  double window = 0.0;    ///< 0: what the slowest wave takes for `distance`  [s]

  template <class Visit>
  void each_key(Visit&& key) {
    key("distance", distance, "m", not_negative,
        "breaks that are no further apart belong to one event, if they are near in time, too; 0: "
        "two mean edges of triangles or tetrahedra, or diameters of spheres");
    key("window", window, "s", not_negative,
        "breaks that are no further apart in time belong to one event; 0: the time in which the "
        "slowest wave goes as far as `distance`");
  }
};

/// Of plane cases.
struct PlaneEmissionConfig : EmissionConfig {
  double thickness = 1.0;  ///<  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    EmissionConfig::each_key(key);
    key("thickness", thickness, "m", Range{1e-9, 1e9},
        "thickness of plane cases: moments and energies of events are those of it");
  }
};

}  // namespace breccia
