#pragma once
// Flow of a fluid through a network of cracks by the cubic law.

#include <vector>

#include "exec/types.hpp"

namespace breccia::fdem {

/// A crack between two vertices, and the fluid in it.
struct FlowCell {
  Index from = 0, to = 0;  ///< vertices at its ends  [-]
  double length = 0.0;     ///<  [m]
  double aperture = 0.0;   ///< between its sides, above 0  [m]
  double bulk = 0.0;       ///< modulus of the fluid, as far as the step of the rock allows  [Pa]
  double fluid = 0.0;      ///< volume that it would have without pressure  [m2]

  double room() const { return length * aperture; }
  /// K (v/V - 1), and none where it is not full.  [Pa]
  double pressure() const { return fluid > room() ? bulk * (fluid / room() - 1.0) : 0.0; }
};

/// Where fluid comes in: vertices that are one place to it, as those of the wall of a hole are.
struct FlowSource {
  std::vector<Index> vertices;  ///< ascending
  bool by_rate = false;
  double given = 0.0;            ///< pressure  [Pa], or rate of inflow  [m2/s]
  std::vector<Index> outlet{};   ///< another place, ascending; empty: there is none
  double outlet_pressure = 0.0;  ///<  [Pa]
};

struct Flowed {
  double injected = 0.0;  ///< volume that came in at the source  [m2]
  double released = 0.0;  ///< volume that left at the outlet  [m2]
  double pressure = 0.0;  ///< at the source, at the end  [Pa]
};

/// Lets fluid flow for a time. From the middle of a crack to its ends it flows between parallel
/// plates (cubic law, Witherspoon et al. 1980):
///
///   q = a^3/(12 mu) (p - p_vertex)/(L/2),   sum of q at each vertex 0 or what comes in
///
/// A crack that is not full has no pressure and takes fluid up until it is: the front. Pressures
/// are those at the end of the step (implicit Euler), so that no step is too long. Volume is kept
/// to rounding: what cracks hold more is what came in and did not leave.
Flowed flow(std::vector<FlowCell>& cells, const FlowSource& source, double viscosity, double span);

}  // namespace breccia::fdem
