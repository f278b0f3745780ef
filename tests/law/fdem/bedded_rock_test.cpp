// Rock that is stiffer along its bedding: stiffness in all directions, energy, turns, edges.

#include <gtest/gtest.h>

#include "exec/error.hpp"
#include "fdem/laws/rock_failure.hpp"
#include "fdem/setup/bedding.hpp"
#include "fdem/setup/materials.hpp"
#include "math/constants.hpp"

namespace breccia::fdem {
namespace bedded_rock_test {

/// Shale: E 30, E' 15, G' 5 GPa, nu 0.2, nu' 0.15.
MaterialConfig shale(double angle) {
  MaterialConfig m;
  m.name = "shale";
  m.young = 30e9;
  m.poisson = 0.2;
  m.bedding.angle = angle;
  m.bedding.young = 15e9;
  m.bedding.poisson = 0.15;
  m.bedding.shear = 5e9;
  return m;
}

Deformation<double> strained(const Mat2& f) {
  return {f, {}, determinant(f)};
}
Mat2 turn(double angle) {
  return {std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle)};
}

/// Columns of the stiffness: stress by unit strains xx, yy and shear, by central differences.
struct Stiffness {
  double c[3][3];
  explicit Stiffness(const ElasticTriangle& law) {
    const double e = 1e-6;
    const Mat2 up[3] = {{1.0 + e, 0.0, 0.0, 1.0}, {1.0, 0.0, 0.0, 1.0 + e}, {1.0, e, 0.0, 1.0}};
    const Mat2 down[3] = {{1.0 - e, 0.0, 0.0, 1.0}, {1.0, 0.0, 0.0, 1.0 - e}, {1.0, -e, 0.0, 1.0}};
    for (int k = 0; k < 3; ++k) {
      const Sym2 a = law.stress(strained(up[k]), 0.0), b = law.stress(strained(down[k]), 0.0);
      c[0][k] = (a.xx - b.xx) / (2.0 * e);
      c[1][k] = (a.yy - b.yy) / (2.0 * e);
      c[2][k] = (a.xy - b.xy) / (2.0 * e);
    }
  }
  /// Strain by a stress: Cramer's rule.
  double strain(int row, const double (&s)[3]) const {
    double m[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m[i][j] = j == row ? s[i] : c[i][j];
    const auto det = [](const double(&a)[3][3]) {
      return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
             a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
             a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    };
    return det(m) / det(c);
  }
};

/// 1/E(t) = cos^4 t/E + sin^4 t/E' + (1/G' - 2 nu'/E') sin^2 t cos^2 t (Lekhnitskii 1963), pulled
/// at t from the planes; in plane strain with the compliances of a slice that does not get thicker.
TEST(BeddedRock, has_the_closed_modulus_in_every_direction) {
  for (const bool stress : {true, false})
    for (int k = -7; k <= 7; ++k) {
      const double t = k * pi / 12.0;
      const Stiffness c(bedded_law(shale(t), stress));  // pulled along x
      const double cc = std::cos(t) * std::cos(t), ss = 1.0 - cc;
      const double s11 = stress ? 1.0 / 30e9 : (1.0 - 0.04) / 30e9;
      const double s22 = stress ? 1.0 / 15e9 : 1.0 / 15e9 - 0.0225 * 30e9 / (15e9 * 15e9);
      const double s12 = stress ? -0.15 / 15e9 : -0.15 * 1.2 / 15e9;
      const double closed = cc * cc * s11 + ss * ss * s22 + (1.0 / 5e9 + 2.0 * s12) * cc * ss;
      EXPECT_NEAR(c.strain(0, {1.0, 0.0, 0.0}), closed, 1e-8 * closed) << t << stress;
    }
}

/// Strain along a line by stress along it, beside it and by shear.
TEST(BeddedRock, tells_what_a_line_does) {
  for (const double t : {0.0, 0.3, 1.1, 2.0}) {
    const MaterialConfig m = shale(-t);
    const Stiffness c(bedded_law(m, true));
    const LineCompliance s = on_line(compliance_of(m, true), t);
    const double size = 1.0 / 15e9;
    EXPECT_NEAR(s.along, c.strain(0, {1.0, 0.0, 0.0}), 1e-8 * size);
    EXPECT_NEAR(s.beside, c.strain(0, {0.0, 1.0, 0.0}), 1e-8 * size);
    EXPECT_NEAR(s.skew, c.strain(0, {0.0, 0.0, 1.0}), 1e-8 * size);
  }
}

/// The acoustic tensor along x.
TEST(BeddedRock, tells_what_waves_meet) {
  for (const double t : {0.0, 0.3, 1.1, 2.0}) {
    const MaterialConfig m = shale(-t);
    const Stiffness c(bedded_law(m, false));
    const WaveModuli met = on_normal(compliance_of(m, false).inverted(), t);
    EXPECT_NEAR(met.pressing, c.c[0][0], 1e-8 * c.c[0][0]);
    EXPECT_NEAR(met.shearing, c.c[2][2], 1e-8 * c.c[2][2]);
  }
}

/// The stress along an edge follows from its stretch, from the stress across it and from shear.
TEST(BeddedRock, has_the_stress_along_its_edges) {
  Config config;
  config.materials = {shale(0.4)};
  for (const double t : {0.0, 0.7, 1.9}) {
    const Vec2 axis{std::cos(t), std::sin(t)}, across{-axis.y, axis.x};
    JointBond within{};
    within.young = 1.0;
    const JointBond bond =
        bond_along(config, config.materials[0], config.materials[0], within, axis);
    const Stiffness c(bedded_law(config.materials[0], true));
    const double given[3] = {2e6, -3e6, 1.5e6};
    const Sym2 s{given[0], given[1], given[2]};
    const Sym2 e{c.strain(0, given), c.strain(1, given), 0.5 * c.strain(2, given)};
    EXPECT_NEAR(stress_along(axis, dot(e * axis, axis), dot(s * across, across),
                             dot(s * across, axis), bond.young, bond.poisson, bond.skew, Sym2{}),
                dot(s * axis, axis), 10.0);
  }
}

TEST(BeddedRock, feels_no_turn_and_has_an_energy) {
  ElasticTriangle law = bedded_law(shale(0.4), false);
  for (int k = 0; k < 12; ++k) {
    const Sym2 s = law.stress(strained(turn(k * pi / 6.0)), 0.0);
    EXPECT_LT(std::abs(s.xx) + std::abs(s.yy) + std::abs(s.xy), 1e-13 * 30e9);
  }
  law.preset = {-3e8, 2e8, 1e8};
  // Work of the first Piola-Kirchhoff stress J sigma F^-T.
  const Mat2 f = turn(0.3) * Mat2{1.05, 0.02, 0.01, 0.93};
  const Sym2 s = law.stress(strained(f), 0.0);
  const Mat2 over = inverse(f);
  const double j = determinant(f), d = 1e-7;
  const double piola[4] = {
      j * (s.xx * over.xx + s.xy * over.xy), j * (s.xx * over.yx + s.xy * over.yy),
      j * (s.xy * over.xx + s.yy * over.xy), j * (s.xy * over.yx + s.yy * over.yy)};
  double Mat2::*const entries[4] = {&Mat2::xx, &Mat2::xy, &Mat2::yx, &Mat2::yy};
  for (int k = 0; k < 4; ++k) {
    Mat2 up = f, down = f;
    up.*entries[k] += d;
    down.*entries[k] -= d;
    EXPECT_NEAR((law.energy(strained(up)) - law.energy(strained(down))) / (2.0 * d), piola[k],
                1e-7 * 30e9 * 0.05);
  }
}

/// Energy under a stress at the start is that of the strain which would have led there.
TEST(BeddedRock, holds_the_energy_of_its_stress_at_the_start) {
  for (const double angle : {0.0, 0.9}) {
    ElasticTriangle law = bedded_law(shale(angle), true);
    const Stiffness c(law);
    const double given[3] = {-3e6, 2e6, 1e6};
    law.preset = {given[0], given[1], given[2]};
    double held = 0.0;
    for (int k = 0; k < 3; ++k) held += 0.5 * given[k] * c.strain(k, given);
    EXPECT_NEAR(law.energy_at_start(), held, 1e-7 * held);
  }
}

TEST(BeddedRock, with_moduli_alike_is_rock_without_bedding) {
  for (const bool stress : {true, false}) {
    MaterialConfig m = shale(0.6);
    m.bedding.young = m.young;
    m.bedding.poisson = -1.0;
    m.bedding.shear = 0.0;
    const ElasticTriangle law = bedded_law(m, stress);
    EXPECT_NEAR(law.lambda, plane_lambda(m.young, m.poisson, stress), 1e-5 * m.young * 1e-9);
    EXPECT_NEAR(law.shear, shear_modulus(m.young, m.poisson), 1e-14 * m.young);
    EXPECT_LT(std::abs(law.tilt) + std::abs(law.bend), 1e-14 * m.young);
  }
}

/// E'/E = 0.1 with nu' = 0.3: 2 nu'^2 = 0.18 > 0.1 (1 - nu).
TEST(BeddedRock, that_cannot_be_is_refused) {
  MaterialConfig m = shale(0.0);
  m.bedding.young = 3e9;
  m.bedding.poisson = 0.3;
  EXPECT_THROW(bedded_law(m, true), InputError);
  m.bedding.poisson = 0.15;
  EXPECT_NO_THROW(bedded_law(m, true));
}

}  // namespace bedded_rock_test
}  // namespace breccia::fdem
