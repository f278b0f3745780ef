#pragma once
// Keys of explosives.

#include <type_traits>

#include "core/keys.hpp"
#include "fdem_shared/laws/explosive.hpp"
#include "math/vec2.hpp"

namespace breccia::fdem_shared {

/// [load.explosive]: the gas of an explosive, by the equation of Jones, Wilkins and Lee
template <class Vector>
struct ExplosiveConfigOf {
  static constexpr bool in_plane = std::is_same_v<Vector, Vec2>;
  double a = 0.0, b = 0.0;                 ///<  [Pa]
  double r1 = 4.0, r2 = 1.0, omega = 0.3;  ///<  [-]
  double energy = 0.0;                     ///< E_0; 0: there is none  [J/m3]
  double charge = 0.0;                     ///< 0: it fills its holes  [m3; in 2D m2]
  bool capped = false;                     ///< in space: stemming closes rims of its region

  ExplosiveGas gas() const { return ExplosiveGas::of(a, b, r1, r2, omega, energy); }

  template <class Visit>
  void each_key(Visit&& key) {
    key("a", a, "Pa", Range{0.0, 1e15},
        "A of p = A exp(-R1 V) + B exp(-R2 V) + C/V^(1 + omega), V the volume of the gas over that "
        "of the explosive");
    key.required("a");
    key("b", b, "Pa", Range{0.0, 1e15}, "B of it");
    key.required("b");
    key("r1", r1, "-", Range{0.1, 100.0}, "R1 of it");
    key.required("r1");
    key("r2", r2, "-", Range{0.01, 100.0}, "R2 of it");
    key.required("r2");
    key("omega", omega, "-", Range{0.01, 10.0}, "omega of it");
    key.required("omega");
    key("energy", energy, "J/m3", Range{0.0, 1e15, Open::low},
        "E_0, energy per volume of explosive, from which C follows");
    key.required("energy");
    key("charge", charge, in_plane ? "m2" : "m3", not_negative,
        in_plane ? "section of the explosive; 0: it fills the holes of its region"
                 : "volume of the explosive; 0: it fills the holes of its region");
    if constexpr (!in_plane)
      key("capped", capped,
          "where its region ends, as at the collar of a borehole, stemming that holds closes the "
          "hole: a flat cap from rim to rim");
  }
};

}  // namespace breccia::fdem_shared
