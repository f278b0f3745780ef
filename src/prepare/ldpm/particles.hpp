#pragma once
// Particles of the lattice discrete particle model: grains of a mix, and nodes on a body's surface.

#include <vector>

#include "core/random.hpp"
#include "prepare/packing/grading.hpp"
#include "prepare/packing/packing.hpp"

namespace breccia::prepare {

/// A mix of concrete, of which grains of [smallest, largest] are placed, the rest is mortar.
struct MixDesign {
  double cement = 315.0;           ///< c, mass of cement over volume of concrete  [kg/m3]
  double water_ratio = 0.5;        ///< w/c, by mass  [-]
  double cement_density = 3150.0;  ///<  [kg/m3]
  double air = 0.03;               ///< share of the volume  [-]
  double smallest = 6e-3;          ///< d_0, smallest grain that is placed  [m]
  double largest = 12e-3;          ///< d_a, largest grain  [m]
  double fuller = 0.5;             ///< n_F of the sieve curve F(d) = (d/d_a)^n_F  [-]
  Grading curve{};                 ///< instead of Fuller's, unless it is empty

  /// Share of the volume that all aggregate takes, v_a.  [-]
  double aggregate() const;
  /// Share that grains of [d_0, d_a] take: v_a0 = (1 - (d_0/d_a)^n_F) v_a, or by the sieves.  [-]
  double placed() const;
};

/// Cement over volume of a mix of known density, water and aggregate over cement by mass.  [kg/m3]
double cement_of(double density, double water_ratio, double aggregate_ratio);

/// Diameters of grains for a volume of concrete, largest first: a sample of the sieves, or of
/// Fuller's curve,
///
///   d = d_0 (1 - P (1 - (d_0/d_a)^q))^(-1/q),  q = 3 - n_F,  P uniform in [0, 1)
///
/// until they fill v_a0 of the volume; the last one, which would fill more, is left out.  [m]
std::vector<double> grain_diameters(const MixDesign& mix, double volume, const Random& random);

/// Particles on the surface come first. Positions are relative to the body's centre.
struct LdpmParticles {
  std::vector<Vec3> position;    ///<  [m]
  std::vector<double> diameter;  ///< of a grain; 0 on the surface  [m]
  Index on_surface = 0;          ///< how many lie on the surface
};

/// Diameter that a particle on the surface has in the tessellation, over d_0.  [-]
inline constexpr double surface_diameter = 1.1;

/// Nodes on vertices, edges and faces of a box or cylinder, at random: on edges about 1.4 spacings
/// apart, on faces no nearer than one, as many as find a place.
/// @throws InputError for a sphere
std::vector<Vec3> surface_nodes(const Container& body, double spacing, const Random& random);

/// Nodes on the surface, d_0 apart at least, and the grains of a mix at random places, the largest
/// first: each (d_i + d_j)/2 + 0.2 d_0 from others, d/2 + 1.1 d_0/2 from nodes, within the body and
/// beside its bars. Bars take their volume from that of the mix.
///
/// Only + - * / and square roots: the same bits on any machine. Cost: about 30 tries a grain.
/// @throws InputError if a grain finds no place
LdpmParticles place_particles(const Container& body, const MixDesign& mix, const Random& random,
                              const std::vector<Capsule>& bars = {});

}  // namespace breccia::prepare
