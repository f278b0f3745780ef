#pragma once
// Rock with its joints, seen from afar: what long waves and slow loads meet.

#include <string>
#include <vector>

#include "fdem/joints/joints.hpp"
#include "fdem/setup/bedding.hpp"
#include "fdem/setup/config.hpp"

namespace breccia::fdem {

/// A material with the joints that its triangles have at the start (docs/theory-fdem.md, 2). Moduli
/// and waves of bedded rock are those along its planes.
struct EffectiveRock {
  std::string material;
  double compliance = 0.0;  ///< that joints add, to each stretch and to half of each shear  [1/Pa]
  double young = 0.0;       ///< E  [Pa]
  double poisson = 0.0;     ///< nu  [-]
  double fast = 0.0, slow = 0.0;  ///< speeds of waves that press and that shear, in the plane [m/s]
  double density = 0.0;           ///<  [kg/m3]
  bool bedded = false;
  PlaneModuli stiffness{};  ///< of bedded rock  [Pa]
  double angle = 0.0;       ///< of its planes  [rad]
  OutOfPlane out_of_plane{};
  /// Stress sigma_1 at which this mesh begins to tear over f_t, mean over all directions: pulled
  /// one way, and with three times as much pressure across, as in a disc; 0 without joints  [-]
  double tension = 0.0, splitting = 0.0;

  /// Impedances of an edge that waves press and shear: rho c_p and rho c_s along its normal.
  struct Impedances {
    double pressing, shearing;  ///<  [Pa s/m]
  };
  Impedances across(const Vec2& edge) const;
};

/// The joints of a model where the host reads them.
struct JointedMesh {
  const std::vector<Index>& material;  ///< of each triangle
  const std::vector<double>& area;     ///< of each triangle  [m2]
  const std::vector<Index>&edge_a, &edge_b, &law;
  const std::vector<double>& length;  ///<  [m]
  const std::vector<Vec2>& along;     ///< edge of side a  [m]
  const std::vector<JointStage>& stage;
  const std::vector<JointBond>& bonds;
};

/// Of each material of the case; one without joints, or without triangles, is as the case says.
std::vector<EffectiveRock> effective_rocks(const Config& config, const JointedMesh& mesh);

}  // namespace breccia::fdem
