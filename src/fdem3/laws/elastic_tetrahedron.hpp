#pragma once
// The stress of a deformable tetrahedron: compressible neo-Hookean, exact for finite rotations.

#include <cmath>

#include "fdem3/laws/bedded_rock.hpp"
#include "math/elementary.hpp"
#include "math/mat3.hpp"

namespace breccia::fdem3 {

/// Gradients of the shape functions of corners 1 to 3 in the reference; that of corner 0 is minus
/// their sum. They are the rows of the inverse of the reference edges x1 - x0, x2 - x0, x3 - x0 as
/// columns.  [1/m]
template <class R>
struct ShapeGradientsOf {
  Vec3Of<R> of[3];

  BR_HD Vec3Of<R> first() const { return -(of[0] + of[1] + of[2]); }
  /// At the start.  [m3]
  BR_HD R volume() const { return 1.0 / (6.0 * dot(of[0], cross(of[1], of[2]))); }
};
using ShapeGradients = ShapeGradientsOf<double>;
/// @param x  corners, with a volume above 0  [m]
BR_HD inline ShapeGradients shape_gradients(const Vec3 (&x)[4]) {
  const Mat3 edges{x[1] - x[0], x[2] - x[0], x[3] - x[0]};
  const Mat3 c = cofactors(edges);
  const double scale = 1.0 / determinant(edges);
  return {{scale * c.a, scale * c.b, scale * c.c}};
}

/// Rates and way of a tetrahedron against its reference.
template <class R>
struct DeformationOf {
  Mat3Of<R> gradient;  ///< F: reference to current  [-]
  Mat3Of<R> cofactor;  ///< cof F = J F^-T  [-]
  R jacobian;          ///< J = det F: current over reference volume  [-]
};
using Deformation = DeformationOf<double>;

/// sum_k u_k (x) G_k of a field u given at the corners.
template <class R>
BR_HD Mat3Of<R> gradient_of(const ShapeGradientsOf<R>& shape, const Vec3Of<R> (&u)[4]) {
  const Vec3Of<R> e1 = u[1] - u[0], e2 = u[2] - u[0], e3 = u[3] - u[0];
  const Vec3Of<R>&g1 = shape.of[0], &g2 = shape.of[1], &g3 = shape.of[2];
  return {g1.x * e1 + g2.x * e2 + g3.x * e3, g1.y * e1 + g2.y * e2 + g3.y * e3,
          g1.z * e1 + g2.z * e2 + g3.z * e3};
}
template <class R>
BR_HD DeformationOf<R> deformation(const ShapeGradientsOf<R>& shape, const Vec3Of<R> (&x)[4]) {
  DeformationOf<R> d;
  d.gradient = gradient_of(shape, x);
  d.cofactor = cofactors(d.gradient);
  d.jacobian = dot(d.gradient.a, d.cofactor.a);
  return d;
}
/// sym L, L = dF/dt F^-1: the rate of deformation.  [1/s]
/// @param v  velocities of the corners  [m/s]
template <class R>
BR_HD Sym3Of<R> deformation_rate(const ShapeGradientsOf<R>& shape, const DeformationOf<R>& d,
                                 const Vec3Of<R> (&v)[4]) {
  const Mat3Of<R> rate = gradient_of(shape, v);
  const R over_j = 1.0 / d.jacobian;
  const auto row = [&over_j](const R& a, const R& b, const R& c, const Mat3Of<R>& m) {  // of L
    return over_j * (a * m.a + b * m.b + c * m.c);
  };
  const Vec3Of<R> x = row(rate.a.x, rate.b.x, rate.c.x, d.cofactor);
  const Vec3Of<R> y = row(rate.a.y, rate.b.y, rate.c.y, d.cofactor);
  const Vec3Of<R> z = row(rate.a.z, rate.b.z, rate.c.z, d.cofactor);
  return {x.x, y.y, z.z, 0.5 * (y.z + z.y), 0.5 * (x.z + z.x), 0.5 * (x.y + y.x)};
}

/// Compressible neo-Hookean solid with viscous damping (docs/theory-fdem3.md, 1):
///
///   P = mu F + (g + eta D) cof F + F S_0,   g = (lambda / 2) (J - 1 / J) - mu / J
///   sigma = P F^T / J
///
/// with D = sym L and the in-situ stress S_0. To first order Hooke's law with Lame's constants.
/// Tension positive. The law of the plane method (fdem/laws/elastic_triangle.hpp) in space, by the
/// first Piola tensor: no inverse of F, one division.
template <class R>
struct ElasticTetrahedronOf {
  R lambda;            ///<  [Pa]
  R shear;             ///< mu  [Pa]
  Sym3Of<R> preset{};  ///< S_0  [Pa]

  BR_HD auto has_preset() const {
    return preset.xx != 0.0 || preset.yy != 0.0 || preset.zz != 0.0 || preset.yz != 0.0 ||
           preset.xz != 0.0 || preset.xy != 0.0;
  }
  /// First Piola tensor.  [Pa]  @param rate  D; only read if eta > 0
  BR_HD Mat3Of<R> piola(const DeformationOf<R>& d, const R& eta, const Sym3Of<R>& rate) const {
    const R g = 0.5 * lambda * (d.jacobian - 1.0 / d.jacobian) - shear / d.jacobian;
    const Mat3Of<R>&f = d.gradient, &c = d.cofactor;
    Mat3Of<R> p{shear * f.a + g * c.a, shear * f.b + g * c.b, shear * f.c + g * c.c};
    const auto flows = eta > 0.0;
    if (any(flows)) {
      p.a = select(flows, p.a + eta * (rate * c.a), p.a);
      p.b = select(flows, p.b + eta * (rate * c.b), p.b);
      p.c = select(flows, p.c + eta * (rate * c.c), p.c);
    }
    const auto held = has_preset();
    if (any(held)) {
      p.a = select(held, p.a + (preset.xx * f.a + preset.xy * f.b + preset.xz * f.c), p.a);
      p.b = select(held, p.b + (preset.xy * f.a + preset.yy * f.b + preset.yz * f.c), p.b);
      p.c = select(held, p.c + (preset.xz * f.a + preset.yz * f.b + preset.zz * f.c), p.c);
    }
    return p;
  }
  /// Energy per reference volume, but for that at the start, S_0 : C^-1 S_0 / 2 by Hooke's law. No
  /// number where the tetrahedron is turned inside out. By the invariants of Green's strain E, of
  /// which J^2 - 1 = 2 I + 4 II + 8 III, so that terms of first order, which cancel, leave no
  /// rounding, whatever way it has turned: of a body at rest it is 1e-32 of the modulus.  [J/m3]
  BR_HD double energy_since_start(const Deformation& d) const {
    if (!(d.jacobian > 0.0)) return NAN;
    const Mat3& f = d.gradient;
    const Sym3 e = green_strain(f);
    const double second =
        e.xx * e.yy - e.xy * e.xy + (e.xx * e.zz - e.xz * e.xz) + (e.yy * e.zz - e.yz * e.yz);
    const double third = e.xx * (e.yy * e.zz - e.yz * e.yz) - e.xy * (e.xy * e.zz - e.yz * e.xz) +
                         e.xz * (e.xy * e.yz - e.yy * e.xz);
    const double higher = 4.0 * second + 8.0 * third,
                 bent = log_less_linear(2.0 * trace(e) + higher);
    return -(0.5 * shear * (higher + bent) + 0.25 * lambda * bent) + contract(preset, e);
  }
};

/// Cauchy stress of a first Piola tensor.  [Pa]
BR_HD inline Sym3 cauchy_stress(const Mat3& p, const Deformation& d) {
  const Mat3& f = d.gradient;
  const double over_j = 1.0 / d.jacobian;
  const auto entry = [&](double pa, double pb, double pc, double fa, double fb, double fc) {
    return over_j * (pa * fa + pb * fb + pc * fc);
  };
  return {entry(p.a.x, p.b.x, p.c.x, f.a.x, f.b.x, f.c.x),
          entry(p.a.y, p.b.y, p.c.y, f.a.y, f.b.y, f.c.y),
          entry(p.a.z, p.b.z, p.c.z, f.a.z, f.b.z, f.c.z),
          entry(p.a.y, p.b.y, p.c.y, f.a.z, f.b.z, f.c.z),
          entry(p.a.x, p.b.x, p.c.x, f.a.z, f.b.z, f.c.z),
          entry(p.a.x, p.b.x, p.c.x, f.a.y, f.b.y, f.c.y)};
}

/// A material's law, with its bedding: sixteen numbers side by side, of which packs gather the
/// first eight, or all.
struct ElasticTetrahedron : ElasticTetrahedronOf<double> {
  Planes planes{};

  BR_HD bool is_bedded() const { return dot(planes.across, planes.across) > 0.0; }
  BR_HD Mat3 piola(const Deformation& d, double eta, const Sym3& rate) const {
    Mat3 p = ElasticTetrahedronOf::piola(d, eta, rate);
    if (is_bedded()) add_to(p, planes.piola(d.gradient));
    return p;
  }
  /// Cauchy stress, without viscosity.  [Pa]
  BR_HD Sym3 stress(const Deformation& d) const { return cauchy_stress(piola(d, 0.0, {}), d); }
  /// Energy per reference volume, with that at the start.  [J/m3]
  BR_HD double energy(const Deformation& d) const {
    double sum = energy_since_start(d);
    if (is_bedded()) sum += planes.energy(green_strain(d.gradient));
    return sum + energy_at_start();
  }
  /// S_0 : C^-1 S_0 / 2.  [J/m3]
  BR_HD double energy_at_start() const {
    if (is_bedded()) return planes.energy_of(preset, lambda, shear);
    const double sum = trace(preset);
    return 0.25 / shear *
           (contract(preset, preset) - lambda / (3.0 * lambda + 2.0 * shear) * sum * sum);
  }
  /// Lame's constants of an even rock that is nowhere softer.  [Pa]
  BR_HD double bound_lambda() const { return lambda + planes.more_lambda; }
  BR_HD double bound_shear() const { return shear + planes.more_shear; }
};

/// Forces that the stress puts on the corners, f_k = -V_0 P G_k; they sum to zero.  [N]
template <class R>
BR_HD void corner_forces(const ShapeGradientsOf<R>& shape, const R& volume, const Mat3Of<R>& piola,
                         Vec3Of<R> (&force)[4]) {
  for (int k = 1; k < 4; ++k) force[k] = (-volume) * (piola * shape.of[k - 1]);
  force[0] = -(force[1] + force[2] + force[3]);
}

BR_HD inline double lame_lambda(double young, double poisson) {
  return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
}

}  // namespace breccia::fdem3
