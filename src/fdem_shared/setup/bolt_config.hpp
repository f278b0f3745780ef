#pragma once
// Keys of rock bolts.

#include <string>
#include <type_traits>
#include <vector>

#include "fdem_shared/setup/config.hpp"
#include "math/vec2.hpp"

namespace breccia::fdem_shared {

/// [[bolt]]: a bar along a polyline, tied to elements by a bond
template <class Vector>
struct BoltConfigOf {
  static constexpr bool in_plane = std::is_same_v<Vector, Vec2>;
  std::string name;
  std::vector<Vector> points;    ///<  [m]
  Vector center{};               ///< of a ring  [m]
  double radius = 0.0;           ///< of a ring, 0: none  [m]
  Vec3 axis{};                   ///< of a ring in space  [-]
  double segment = 0.1;          ///<  [m]
  double diameter = 0.025;       ///<  [m]
  double area = 0.0;             ///< of its section, 0: a round bar's  [m2]
  double spacing = 1.0;          ///< between bolts across the plane; in space no key  [m; -]
  double young = 200e9;          ///<  [Pa]
  double yield = 500e6;          ///<  [Pa]
  double bond_stiffness = 1e9;   ///< of one bolt  [N/m2]
  double bond_strength = 500e3;  ///< of one bolt  [N/m]
  double bedding = 0.0;          ///< of one bolt across; 0: it does not act across  [N/m2]
  double grout = 30e6;           ///< f_c  [Pa]
  std::string anchored = "none";
  std::string stage;

  bool is_ring() const { return radius > 0.0; }

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the bolt: summary.json and bolts.csv tell of it by it");
    key.required("name");
    key("points", points, "m", any_number,
        in_plane ? "points [[x, y], ...] that it runs along, two or more"
                 : "points [[x, y, z], ...] that it runs along, two or more");
    key("center", center, "m", any_number,
        in_plane ? "centre of a ring: [x, y]" : "centre of a ring: [x, y, z]");
    key("radius", radius, "m", Range{0.0, 1e6},
        "of a closed ring around center, in place of points: a lining that bears thrust; 0: none");
    if constexpr (!in_plane)
      key("axis", axis, "-", any_number,
          "direction of the axis of a ring, as of the tunnel that it lines; of any length");
    key("segment", segment, "m", Range{1e-6, 1e6},
        in_plane
            ? "it is tied to a triangle at its points, and between them at most so far apart"
            : "it is tied to a tetrahedron at its points, and between them at most so far apart");
    key("diameter", diameter, "m", Range{1e-6, 10.0}, "of its round bar");
    key("area", area, "m2", Range{0.0, 1e6},
        in_plane ? "of its section if that is not round, as of an arch rib, or of sprayed concrete "
                   "over the spacing; 0: of a round bar"
                 : "of its section if that is not round, as of an arch rib; 0: of a round bar");
    if constexpr (in_plane)
      key("spacing", spacing, "m", Range{1e-6, 1e6},
          "distance between bolts across the plane: forces are divided by it");
    key("young", young, "Pa", Range{1e3, 1e15}, "Young's modulus of its bar");
    key("yield", yield, "Pa", sane_strength, "stress at which it yields, without hardening");
    key("bond_stiffness", bond_stiffness, "N/m2", Range{1.0, 1e15},
        "force along the bar, per length of one bolt and per slip of the bar against the rock");
    key("bond_strength", bond_strength, "N/m", Range{1e-6, 1e15},
        "force per length of one bolt at which its bond slips on without growing");
    key("bedding", bedding, "N/m2", Range{0.0, 1e15},
        "force across the bar, per length of one bolt and per way of the bar into the grout: where "
        "a joint slides, it resists as a beam on an elastic foundation (dowel action); 0: it does "
        "not");
    key("grout", grout, "Pa", sane_strength,
        "compressive strength f_c of grout and rock: across, one bolt bears at most 1.27 d^2 "
        "sqrt(f_c yield)");
    key("anchored", anchored, OneOf{"none", "start", "end", "both"},
        "ends at which it does not slip: a plate with a nut, an anchor");
    key("stage", stage,
        "stage from whose beginning on it is there, without force at first; empty: from the start");
  }
};

}  // namespace breccia::fdem_shared
