#pragma once
// Reinforcement: mats of straight bars through a box, or bars as they are drawn, each a chain of
// elements.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dem/setup/config.hpp"
#include "prepare/packing/packing.hpp"
#include "prepare/shapes/surface.hpp"

namespace breccia::prepare {

/// A straight bar: from the centre of its first element to that of its last, in the body's frame.
using Bar = Capsule;

/// The bars of the mats of a box of edges `size` centred at the origin. Outer bars run along x at
/// depth `cover` below the face, inner bars along y, one diameter deeper: they touch at crossings.
/// Bars share the width evenly and end with round caps at the faces of the box (docs/theory.md,
/// bars).
std::vector<Bar> bars_through(const dem::RebarConfig& rebar, const Vec3& size);

/// Whether bars reinforce a body.
bool has_bars(const std::vector<dem::BodyConfig>& bodies, const dem::BodyConfig& host);

/// A bar as a chain of elements.
struct Chain {
  std::string name;             ///< for messages
  std::vector<Bar> segments;    ///< straight parts
  bool closed = false;          ///< the last element joins the first one
  double diameter = 0.0;        ///<  [m]
  std::vector<Vec3> centres;    ///< of its elements, one at each corner  [m]
  std::vector<double> piece;    ///< of bar that belongs to each  [m]
  std::vector<double> spacing;  ///< L of each, mean of both sides  [m]

  double radius() const { return 0.5 * diameter; }
  double area() const;  ///<  [m2]
  /// rho A times its piece  [kg]
  double mass(double density, std::size_t element) const;
  /// m (L^2 / 12 + d^2 / 16) about every axis  [kg m2]
  double inertia(double element_mass, std::size_t element) const;
};

/// The chains of a rebar through a body: as drawn, or the mats of a box of edges `size`. Each
/// straight part of a drawn bar is shared by whole pieces of about the wanted spacing.
std::vector<Chain> chains_through(const dem::RebarConfig& rebar, const Vec3& size);

/// Of the steel, as its elements weigh it: area times length  [m3]
double bars_volume(const std::vector<Chain>& chains);

/// The place of the axis of a straight part at which it comes closer to the faces of its body than
/// half its diameter, in the frame of the body; none: it lies inside.  [m]
using PlaceOutside = std::function<std::optional<Vec3>(const Bar& part)>;

/// Reasons why these bars do not fit their body, one sentence each; empty: they fit. Of a body
/// that a surface encloses, bars_outside tells the rest.
std::vector<std::string> bar_problems(const dem::RebarConfig& rebar, const dem::BodyConfig& host);

/// Bars of a body that do not lie within the surface that encloses it, one sentence each with the
/// path of their key.
std::vector<std::string> bars_outside(const std::vector<dem::BodyConfig>& bodies,
                                      const dem::BodyConfig& host, const Surface& surface);

/// Where bars of one or two rebars of a body come closer than they may; one sentence at most.
std::vector<std::string> crossing_problems(const std::vector<Chain>& bars,
                                           const std::vector<Chain>& others);

}  // namespace breccia::prepare
