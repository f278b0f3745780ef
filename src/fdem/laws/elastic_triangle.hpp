#pragma once
// The stress of a deformable triangle: compressible neo-Hookean, exact for finite rotations.

#include "math/vec2.hpp"

namespace breccia::fdem {

/// How a triangle has moved and deformed against its reference.
struct Deformation {
  Mat2 gradient;           ///< F: reference to current  [-]
  Mat2 velocity_gradient;  ///< L  [1/s]
  double jacobian;         ///< J = det F: current over reference area  [-]
};

/// @param shape_inverse  inverse of the reference edges X1 - X0, X2 - X0 as columns  [1/m]
/// @param x, v           corners and their velocities  [m], [m/s]
BR_HD inline Deformation deformation(const Mat2& shape_inverse, const Vec2 (&x)[3],
                                     const Vec2 (&v)[3]) {
  const Mat2 edges = columns(x[1] - x[0], x[2] - x[0]);
  const Mat2 rates = columns(v[1] - v[0], v[2] - v[0]);
  Deformation d;
  d.gradient = edges * shape_inverse;
  d.velocity_gradient = rates * inverse(edges);
  d.jacobian = determinant(d.gradient);
  return d;
}

/// Compressible neo-Hookean solid with viscous damping (docs/theory.md, triangles):
///
///   sigma = (mu / J) (B - I) + (lambda / 2) (J - 1 / J) I + eta D,      B = F F^T, D = sym L
///
/// To first order Hooke's law of plane strain with Lame's constants, and of plane stress with
/// lambda* = E nu / (1 - nu^2). Tension positive. Source: Lukas 2014, section 2; the law of the
/// Y family after 2010, whose energy is psi below (Munjiza 2004, chapter 4, has another one).
struct ElasticTriangle {
  double lambda;  ///< lambda of plane strain, lambda* of plane stress  [Pa]
  double shear;   ///< mu  [Pa]
  Sym2 preset{};  ///< in-situ stress S_0 of the reference, adds F S_0 F^T / J  [Pa]
  bool has_preset = false;

  /// Cauchy stress.  [Pa]
  BR_HD Sym2 stress(const Deformation& d, double eta) const {
    const Mat2& f = d.gradient;
    const double over_j = 1.0 / d.jacobian, scale = shear * over_j;
    const double volumetric = 0.5 * lambda * (d.jacobian - over_j);
    const Mat2& l = d.velocity_gradient;
    Sym2 sigma{scale * (f.xx * f.xx + f.xy * f.xy - 1.0) + volumetric + eta * l.xx,
               scale * (f.yx * f.yx + f.yy * f.yy - 1.0) + volumetric + eta * l.yy,
               scale * (f.xx * f.yx + f.xy * f.yy) + 0.5 * eta * (l.xy + l.yx)};
    if (has_preset) {
      const Vec2 x = preset * Vec2{f.xx, f.xy}, y = preset * Vec2{f.yx, f.yy};
      sigma.xx += over_j * (f.xx * x.x + f.xy * x.y);
      sigma.yy += over_j * (f.yx * y.x + f.yy * y.y);
      sigma.xy += over_j * (f.yx * x.x + f.yy * x.y);
    }
    return sigma;
  }
  /// Energy per reference area. Host only: it needs a logarithm.  [J/m2 per unit thickness]
  double energy(const Deformation& d) const {
    const Mat2& f = d.gradient;
    const double trace = f.xx * f.xx + f.xy * f.xy + f.yx * f.yx + f.yy * f.yy;
    const double j = d.jacobian;
    const double log_j = std::log(j);
    const Sym2 strain{0.5 * (f.xx * f.xx + f.yx * f.yx - 1.0),
                      0.5 * (f.xy * f.xy + f.yy * f.yy - 1.0), 0.5 * (f.xx * f.xy + f.yx * f.yy)};
    return 0.5 * shear * (trace - 2.0 - 2.0 * log_j) + 0.25 * lambda * (j * j - 1.0 - 2.0 * log_j) +
           contract(preset, strain);
  }
};

/// Forces that the stress of a triangle puts on its corners: sigma n_i / 2 with the outward vector
/// n_i of the opposite edge; they sum to zero. [N per unit thickness]
BR_HD inline void corner_forces(const Sym2& sigma, const Vec2 (&x)[3], Vec2 (&force)[3]) {
  for (int i = 0; i < 3; ++i) {
    const Vec2 edge = x[(i + 2) % 3] - x[(i + 1) % 3];
    force[i] = 0.5 * (sigma * Vec2{edge.y, -edge.x});
  }
}

/// Lame's first constant of the plane problem.
BR_HD inline double plane_lambda(double young, double poisson, bool plane_stress) {
  return plane_stress ? young * poisson / (1.0 - poisson * poisson)
                      : young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
}
BR_HD inline double shear_modulus(double young, double poisson) {
  return young / (2.0 * (1.0 + poisson));
}

}  // namespace breccia::fdem
