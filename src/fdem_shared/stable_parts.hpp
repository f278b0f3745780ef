#pragma once
// From the largest sum of a row's stiffness to a stable step (Gershgorin's bound).

#include "math/vec.hpp"

namespace breccia::fdem_shared {

/// Step of a mass that oscillates with at most omega and loses energy: central differences are
/// stable below 2/omega (sqrt(1 + xi^2) - xi).
/// @param square  omega^2  [1/s2]  @param lost  [N s/m]
BR_HD inline double stable_step_of(double square, double lost, double mass) {
  const double omega = sqrt(square);
  const double xi = 0.5 * lost / (mass * omega);
  return 2.0 / omega * (sqrt(1.0 + xi * xi) - xi);
}

/// Shares of the row sum of a corner; in 2D per unit thickness.
struct StepParts {
  double element = 0.0, joint = 0.0, contact = 0.0;  ///<  [N/m]
  double viscous = 0.0, absorbed = 0.0;              ///<  [N s/m]
  double square = 0.0;                               ///< omega^2 bound  [1/s2]
  double step = 1e300;                               ///<  [s]

  /// The bound and the step, from the shares.
  BR_HD void finish(double mass) {
    square = (element + joint + contact) / mass;
    step = stable_step_of(square, viscous + absorbed, mass);
  }
};

}  // namespace breccia::fdem_shared
