#pragma once
// Reinforcement: mats of straight bars through a box, each bar a chain of elements.

#include <string>
#include <vector>

#include "dem/config.hpp"
#include "prepare/packing.hpp"

namespace breccia::prepare {

/// One bar: from the centre of its first element to that of its last, in the frame of the box.
using Bar = Capsule;

/// The bars of a box of edges `size` centred at the origin. Outer bars run along x at depth `cover`
/// below the face, inner bars along y, one diameter deeper: they touch at crossings. Bars share the
/// width evenly and end with round caps at the faces of the box (docs/theory.md, bars).
std::vector<Bar> bars_through(const dem::RebarConfig& rebar, const Vec3& size);

/// Reasons why these bars do not fit the box, one sentence each; empty: they fit.
std::vector<std::string> bar_problems(const dem::RebarConfig& rebar, const Vec3& size);

/// The element of a bar as a chain: spacing L = length / (elements - 1).
struct BarElements {
  double spacing;  ///< L  [m]
  double area;     ///< A = pi d^2 / 4  [m2]
  double diameter;

  /// rho A L, half of it at the two ends  [kg]
  double mass(double density, int element, int count) const;
  /// m (L^2 / 12 + d^2 / 16) about every axis  [kg m2]
  double inertia(double element_mass) const;
};
BarElements bar_elements(const dem::RebarConfig& rebar, const Bar& bar);
/// Centre of an element along a bar  [m]
Vec3 bar_element_centre(const Bar& bar, int element, int count);
/// Of the steel, as its elements weigh it: area times length  [m3]
double bars_volume(const dem::RebarConfig& rebar, const std::vector<Bar>& bars);

}  // namespace breccia::prepare
