#pragma once
// The stress of a deformable triangle: compressible neo-Hookean, exact for finite rotations.

#include <cmath>

#include "math/elementary.hpp"
#include "math/single.hpp"
#include "math/vec2.hpp"

namespace breccia::fdem {

/// Green's strain (F^T F - I) / 2, but twice its xy.  [-]
template <class R>
BR_HD Sym2Of<R> green_strain(const Mat2Of<R>& f) {
  return {0.5 * (f.xx * f.xx + f.yx * f.yx - 1.0), 0.5 * (f.xy * f.xy + f.yy * f.yy - 1.0),
          f.xx * f.xy + f.yx * f.yy};
}

/// How a triangle has moved and deformed against its reference.
template <class R>
struct Deformation {
  Mat2Of<R> gradient;           ///< F: reference to current  [-]
  Mat2Of<R> velocity_gradient;  ///< L  [1/s]
  R jacobian;                   ///< J = det F: current over reference area  [-]

  /// B - I, B = F F^T.  [-]
  BR_HD Sym2Of<R> stretch() const {
    const Vec2Of<R> row_x{gradient.xx, gradient.xy}, row_y{gradient.yx, gradient.yy};
    return {dot(row_x, row_x) - 1.0, dot(row_y, row_y) - 1.0, dot(row_x, row_y)};
  }
  /// J - 1/J. @param over_j  1/J  [-]
  BR_HD R swelling(const R& over_j) const { return jacobian - over_j; }
  BR_HD Sym2Of<R> green() const { return green_strain(gradient); }
};

/// Of a triangle that is computed in single precision, what must be taken in double and rounded
/// then: differences of its corners, and strains, which are small beside the 1 of F, however far
/// the triangle has turned.
template <class R>
struct TriangleStrains {
  Vec2Of<R> edge[2];   ///< from corner 0 to corners 1 and 2  [m]
  Vec2Of<R> rate[2];   ///< of the edges  [m/s]
  Mat2Of<R> gradient;  ///< F  [-]
  Sym2Of<R> stretch;   ///< B - I  [-]
  R growth;            ///< J - 1  [-]
  Sym2Of<R> green;     ///< of bedded rock, else 0; see green_strain()  [-]
};
/// @param W  double or a pack of doubles
template <class W>
BR_HD TriangleStrains<W> strains(const Mat2Of<W>& shape_inverse, const Vec2Of<W> (&x)[3],
                                 const Vec2Of<W> (&v)[3], bool bedded) {
  const Vec2Of<W> first = x[1] - x[0], second = x[2] - x[0];
  Deformation<W> d;
  d.gradient = columns(first, second) * shape_inverse;
  return {{first, second}, {v[1] - v[0], v[2] - v[0]},    d.gradient,
          d.stretch(),     determinant(d.gradient) - 1.0, bedded ? d.green() : Sym2Of<W>{}};
}

/// In single precision: from strains that were taken in double.
template <class V>
struct Deformation<SingleOf<V>> {
  using R = SingleOf<V>;
  TriangleStrains<R> taken;
  Mat2Of<R> gradient, velocity_gradient;
  R jacobian;

  BR_HD explicit Deformation(const TriangleStrains<R>& by)
      : taken(by),
        gradient(by.gradient),
        velocity_gradient(columns(by.rate[0], by.rate[1]) *
                          inverse(columns(by.edge[0], by.edge[1]))),
        jacobian(1.0 + by.growth) {}
  BR_HD Sym2Of<R> stretch() const { return taken.stretch; }
  /// g (2 + g)/J, g = J - 1.
  BR_HD R swelling(const R& over_j) const { return taken.growth * (2.0 + taken.growth) * over_j; }
  BR_HD Sym2Of<R> green() const { return taken.green; }
};

/// @param shape_inverse  inverse of the reference edges X1 - X0, X2 - X0 as columns  [1/m]
/// @param x, v           corners and their velocities  [m], [m/s]
template <class R>
BR_HD Deformation<R> deformation(const Mat2Of<R>& shape_inverse, const Vec2Of<R> (&x)[3],
                                 const Vec2Of<R> (&v)[3]) {
  const Mat2Of<R> edges = columns(x[1] - x[0], x[2] - x[0]);
  const Mat2Of<R> rates = columns(v[1] - v[0], v[2] - v[0]);
  Deformation<R> d;
  d.gradient = edges * shape_inverse;
  d.velocity_gradient = rates * inverse(edges);
  d.jacobian = determinant(d.gradient);
  return d;
}

/// Compressible neo-Hookean solid with viscous damping (docs/theory-fdem.md, 1):
///
///   sigma = (mu / J) (B - I) + (lambda / 2) (J - 1 / J) I + F S_0 F^T / J + eta D
///
/// with B = F F^T, D = sym L, and the in-situ stress S_0. To first order Hooke's law of plane
/// strain with Lame's constants, and of plane stress with lambda* = E nu / (1 - nu^2). Tension
/// positive. Source: Lukas 2014, section 2; the law of the Y family after 2010, whose energy is
/// below (Munjiza 2004, chapter 4, has another one).
///
/// Bedded rock is as stiff as its planes say. Its energy has two terms more, in Green's strain E =
/// (F^T F - I) / 2 and the deviator D = ((c, s), (s, -c)) of the direction of the planes, c and s
/// of twice their angle:
///
///   p tr E (D : E) + q (D : E)^2 / 2,   S = p (D : E) I + (p tr E + q D : E) D,   F S F^T / J
///
/// so that along and across the planes C11 = lambda + 2 mu + 2 p + q, C22 = lambda + 2 mu - 2 p +
/// q, C12 = lambda - q, C66 = mu (fdem/setup/bedding.hpp). Eight numbers side by side: packs gather
/// them.
template <class R>
struct ElasticLaw {
  R lambda;            ///< lambda of plane strain, lambda* of plane stress  [Pa]
  R shear;             ///< mu  [Pa]
  Sym2Of<R> preset{};  ///< S_0  [Pa]
  R tilt{};            ///< p: a fourth of C11 - C22; 0: no bedding  [Pa]
  R bend{};            ///< q  [Pa]
  R planes{};          ///< tangent of the planes' angle  [-]

  BR_HD auto is_bedded() const { return abs(tilt) + abs(bend) > 0.0; }
  /// Cauchy stress.  [Pa]
  BR_HD Sym2Of<R> stress(const Deformation<R>& d, const R& eta) const {
    const Mat2Of<R>& f = d.gradient;
    const R over_j = 1.0 / d.jacobian, scale = shear * over_j;
    const R volumetric = 0.5 * lambda * d.swelling(over_j);
    const Sym2Of<R> stretch = d.stretch();
    const Mat2Of<R>& l = d.velocity_gradient;
    const Vec2Of<R> row_x{f.xx, f.xy}, row_y{f.yx, f.yy};
    Sym2Of<R> kept = preset;  // by the reference: S_0, and S of bedded rock
    const auto bedded = is_bedded();
    if (any(bedded)) {
      const Sym2Of<R> more = answer_of_planes(d.green());
      kept = {select(bedded, kept.xx + more.xx, kept.xx),
              select(bedded, kept.yy + more.yy, kept.yy),
              select(bedded, kept.xy + more.xy, kept.xy)};
    }
    const Vec2Of<R> preset_x = kept * row_x, preset_y = kept * row_y;
    return {scale * stretch.xx + volumetric + eta * l.xx + over_j * dot(row_x, preset_x),
            scale * stretch.yy + volumetric + eta * l.yy + over_j * dot(row_y, preset_y),
            scale * stretch.xy + 0.5 * eta * (l.xy + l.yx) + over_j * dot(row_y, preset_x)};
  }
  /// sigma_zz of plane strain, where B_zz = 1: (lambda / 2) (J - 1 / J).  [Pa]
  BR_HD R stress_across(const Deformation<R>& d) const {
    return 0.5 * lambda * (d.jacobian - 1.0 / d.jacobian);
  }
  /// Cosine and sine of twice the planes' angle.
  BR_HD Vec2Of<R> twice_the_angle() const {
    const R square = planes * planes, over = 1.0 / (1.0 + square);
    return {(1.0 - square) * over, 2.0 * planes * over};
  }
  /// Energy per reference area, with what it held at the start: S_0 : C^-1 S_0 / 2 by Hooke's law,
  /// which makes it that of a rock without stress that was strained since. No number where the
  /// triangle is turned inside out. By differences that vanish at rest, so that no rounding of
  /// first order is left, whatever way the triangle has turned: tr C - 2 J = (F_xx - F_yy)^2 +
  /// (F_xy + F_yx)^2, and J - 1 - ln J.  [J/m2 per unit thickness]
  BR_HD R energy(const Deformation<R>& d) const {
    const Mat2Of<R>& f = d.gradient;
    const R stretched = f.xx - f.yy, sheared = f.xy + f.yx;
    const R grown = d.jacobian - 1.0, bent = log_less_linear(grown);
    const Sym2Of<R> strain{0.5 * (f.xx * f.xx + f.yx * f.yx - 1.0),
                           0.5 * (f.xy * f.xy + f.yy * f.yy - 1.0),
                           0.5 * (f.xx * f.xy + f.yx * f.yy)};
    return 0.5 * shear * (stretched * stretched + sheared * sheared - 2.0 * bent) +
           0.25 * lambda * (grown * grown - 2.0 * bent) + contract(preset, strain) +
           energy_at_start() + energy_of_planes(f);
  }
  BR_HD R energy_at_start() const {
    const R trace = preset.xx + preset.yy;
    const R even =
        0.25 / shear * (contract(preset, preset) - 0.5 * lambda / (lambda + shear) * trace * trace);
    const auto bedded = is_bedded();
    return any(bedded) ? select(bedded, bedded_at_start(), even) : even;
  }

 private:
  /// tr E and D : E. @param green  see green_strain()
  BR_HD Vec2Of<R> strains_of_planes(const Sym2Of<R>& green, const Vec2Of<R>& twice) const {
    return {green.xx + green.yy, twice.x * (green.xx - green.yy) + twice.y * green.xy};
  }
  /// S.  [Pa]
  BR_HD Sym2Of<R> answer_of_planes(const Sym2Of<R>& green) const {
    const Vec2Of<R> twice = twice_the_angle(), e = strains_of_planes(green, twice);
    const R alike = tilt * e.y, turned = tilt * e.x + bend * e.y;
    return {alike + turned * twice.x, alike - turned * twice.x, turned * twice.y};
  }
  BR_HD R energy_of_planes(const Mat2Of<R>& f) const {
    const Vec2Of<R> e = strains_of_planes(green_strain(f), twice_the_angle());
    return (tilt * e.x + 0.5 * bend * e.y) * e.y;
  }
  BR_HD R bedded_at_start() const {
    const Vec2Of<R> twice = twice_the_angle();
    const R mean = 0.5 * (preset.xx + preset.yy), half = 0.5 * (preset.xx - preset.yy);
    const R more = twice.x * half + twice.y * preset.xy;
    const R along = mean + more, across = mean - more;
    const R slid = twice.x * preset.xy - twice.y * half;
    const R c12 = lambda - bend, c11 = lambda + 2.0 * shear + 2.0 * tilt + bend,
            c22 = lambda + 2.0 * shear - 2.0 * tilt + bend;
    return 0.5 * ((c22 * along * along - 2.0 * c12 * along * across + c11 * across * across) /
                      (c11 * c22 - c12 * c12) +
                  slid * slid / shear);
  }
};
using ElasticTriangle = ElasticLaw<double>;  ///< of a material

/// Forces that the stress of a triangle puts on its corners: sigma n_i / 2 with the outward vector
/// n_i of the opposite edge; they sum to zero. [N per unit thickness]
template <class R>
BR_HD void corner_forces(const Sym2Of<R>& sigma, const Vec2Of<R> (&x)[3], Vec2Of<R> (&force)[3]) {
  const R half = constant<R>(0.5);
  for (int i = 0; i < 3; ++i) {
    const Vec2Of<R> edge = x[(i + 2) % 3] - x[(i + 1) % 3];
    force[i] = half * (sigma * Vec2Of<R>{edge.y, -edge.x});
  }
}

/// In single precision on corners 1 and 2; corner 0 gets what makes the sum zero, in double.
/// @param edge  from corner 0 to corners 1 and 2  [m]
template <class R>
BR_HD void corner_forces(const Sym2Of<R>& sigma, const Vec2Of<R> (&edge)[2],
                         Vec2Of<R> (&force)[2]) {
  const R half = constant<R>(0.5);
  force[0] = half * (sigma * Vec2Of<R>{-edge[1].y, edge[1].x});
  force[1] = half * (sigma * Vec2Of<R>{edge[0].y, -edge[0].x});
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
