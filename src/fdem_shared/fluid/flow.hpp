#pragma once
// Flow of a fluid through a network of cracks by the cubic law.

#include <array>
#include <vector>

#include "fdem_shared/fluid/cracks.hpp"

namespace breccia::fdem_shared {

/// Flow out of a crack at its ports: q_i = sum over j of T_ij (p - p_j).
template <int ports>
using Conductance = std::array<std::array<double, static_cast<std::size_t>(ports)>,
                               static_cast<std::size_t>(ports)>;

/// A crack of the plane, and the fluid in it.
struct LineCell {
  static constexpr int ports = 2;
  Port port[ports] = {};  ///< vertices at its ends  [-]
  double length = 0.0;    ///<  [m]
  double aperture = 0.0;  ///< between its sides, above 0  [m]
  double bulk = 0.0;      ///< modulus of the fluid, as far as the step of the rock allows  [Pa]
  double fluid = 0.0;     ///< volume that it would have without pressure  [m2]

  double extent() const { return length; }
  double room() const { return length * aperture; }
  /// K (v/V - 1), and none where it is not full.  [Pa]
  double pressure() const { return fluid > room() ? bulk * (fluid / room() - 1.0) : 0.0; }
  Conductance<ports> passes(double viscosity, bool) const {
    const double each = aperture * aperture * aperture / (6.0 * viscosity * length);
    return {{{each, 0.0}, {0.0, each}}};
  }
};

/// A crack in space, a triangle.
struct FaceCell {
  static constexpr int ports = 3;
  Port port[ports] = {};    ///< edges  [-]
  double edge[ports] = {};  ///< their lengths  [m]
  double area = 0.0;        ///<  [m2]
  double aperture = 0.0;    ///< in the mean, above 0  [m]
  double bulk = 0.0;        ///< likewise  [Pa]
  double fluid = 0.0;       ///< likewise  [m3]

  double extent() const { return area; }
  double room() const { return area * aperture; }
  double pressure() const { return fluid > room() ? bulk * (fluid / room() - 1.0) : 0.0; }
  /// Of one that is full: exact where the pressure is linear, on triangles of any shape, since then
  /// sum_j T_ij (x_j - x) = a^3/(12 mu) l_i n_i; on equilateral ones each edge for itself. Else
  /// over the way 2 A/(3 l_i) from its centroid to each edge, for itself: what comes in comes in.
  Conductance<ports> passes(double viscosity, bool full) const {
    const double cube = aperture * aperture * aperture / (12.0 * viscosity * area);
    double square[ports], sum = 0.0;
    for (int k = 0; k < ports; ++k) sum += square[k] = edge[k] * edge[k];
    Conductance<ports> all{};
    for (int i = 0; i < ports; ++i)
      for (int j = 0; j < ports; ++j) {
        double& here = all[at(i)][at(j)];
        if (!full)
          here = i == j ? 1.5 * cube * square[i] : 0.0;
        else if (i == j)
          here = cube * (square[i] + sum / 6.0);
        else  // l_i n_i . l_j n_j = (l_k^2 - l_i^2 - l_j^2)/2
          here = cube * (0.5 * (square[3 - i - j] - square[i] - square[j]) + sum / 6.0);
      }
    return all;
  }
};

/// Where fluid comes in: ports that are one place to it, as those of the wall of a hole are.
struct FlowSource {
  std::vector<Port> ports;  ///< ascending
  bool by_rate = false;
  double given = 0.0;            ///< pressure  [Pa], or rate of inflow  [m2/s; in space m3/s]
  std::vector<Port> outlet{};    ///< another place, ascending; empty: there is none
  double outlet_pressure = 0.0;  ///<  [Pa]
};

struct Flowed {
  double injected = 0.0;  ///< volume that came in at the source  [m2; in space m3]
  double released = 0.0;  ///< volume that left at the outlet  [likewise]
  double pressure = 0.0;  ///< at the source, at the end  [Pa]
};

/// Lets fluid flow for a time. From the middle of a crack to its ports it flows between parallel
/// plates (cubic law, Witherspoon et al. 1980), in the plane over half of its length:
///
///   q = a^3/(12 mu) (p - p_port)/(L/2),   sum of q at each port 0 or what comes in
///
/// A crack that is not full has no pressure and takes fluid up until it is: the front. Pressures
/// are those at the end of the step (implicit Euler), so that no step is too long. Volume is kept
/// to rounding: what cracks hold more is what came in and did not leave. Written in network.hpp,
/// made for each method in its fluid/flow.cpp.
template <class Cell>
Flowed flow(std::vector<Cell>& cells, const FlowSource& source, double viscosity, double span);

}  // namespace breccia::fdem_shared
