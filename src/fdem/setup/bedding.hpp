#pragma once
// Rock that is stiffer along its bedding than across it: from moduli to constants of laws.

#include "fdem/laws/elastic_triangle.hpp"
#include "fdem/setup/config.hpp"

namespace breccia::fdem {

/// Stiffness or compliance of the plane problem with respect to the planes of bedding: 1 along
/// them, 2 across.
struct PlaneModuli {
  double c11 = 0.0, c22 = 0.0, c12 = 0.0, c66 = 0.0;  ///< [Pa], or [1/Pa]

  PlaneModuli inverted() const;
  bool is_positive() const;
};

/// Moduli across its planes, those that are left out filled in.
struct AcrossPlanes {
  double young, poisson, shear;  ///< E', nu', G'  [Pa], [-], [Pa]
};
AcrossPlanes across_planes(const MaterialConfig& material);
/// @throws InputError naming the key where no such rock can be
void refuse_impossible_bedding(const MaterialConfig& material);

/// Compliance of bedded rock, transversely isotropic with its axis in the plane: with E, nu in the
/// planes, E', nu', G' across them (nu': strain along the planes over that across, pressed across)
///
///   plane stress  S11 = 1/E            S22 = 1/E'               S12 = -nu'/E'           S66 = 1/G'
///   plane strain  S11 = (1 - nu^2)/E   S22 = 1/E' - nu'^2 E/E'^2  S12 = -nu' (1 + nu)/E'
PlaneModuli compliance_of(const MaterialConfig& material, bool plane_stress);

/// Its law. @throws InputError naming the key where no such rock can be
ElasticTriangle bedded_law(const MaterialConfig& material, bool plane_stress);

/// Shares of the stresses along and across in that across the plane, sigma_zz of plane strain.
struct OutOfPlane {
  double along = 0.0, across = 0.0;  ///< nu, nu' E/E'  [-]
};
OutOfPlane out_of_plane_of(const MaterialConfig& material);

/// Compliances along a line at an angle from the planes.
struct LineCompliance {
  double along, beside, skew;  ///< of the strain along it: by stress along, across, shear  [1/Pa]
};
LineCompliance on_line(const PlaneModuli& compliance, double angle);

/// Stiffness that plane waves along a normal at an angle from the planes meet.
struct WaveModuli {
  double pressing, shearing;  ///< of motion along the normal, and across it  [Pa]
};
WaveModuli on_normal(const PlaneModuli& stiffness, double angle);

}  // namespace breccia::fdem
