// The stress of a deformable tetrahedron: reference values, rotation, energy, viscosity.

#include "fdem3/laws/elastic_tetrahedron.hpp"

#include <gtest/gtest.h>

#include "fdem/laws/elastic_triangle.hpp"
#include "math/constants.hpp"

namespace breccia::fdem3 {
namespace elastic_tetrahedron_test {

constexpr double young = 60e9, poisson = 0.25;

ElasticTetrahedron law_of(const Sym3& preset = {}) {
  return {{lame_lambda(young, poisson), fdem::shear_modulus(young, poisson), preset}, {}};
}

/// Turned by 30 degrees about (1, 2, 3).
Vec3 turned(const Vec3& v) {
  const double s = 0.5, c = std::sqrt(0.75), n = 1.0 / std::sqrt(14.0);
  const Vec3 axis{n, 2.0 * n, 3.0 * n};
  return c * v + s * cross(axis, v) + ((1.0 - c) * dot(axis, v)) * axis;
}

/// The reference tetrahedron: stretched, turned and moved.
struct Example {
  Vec3 reference[4] = {
      {0.0, 0.0, 0.0}, {1e-3, 0.0, 0.0}, {0.2e-3, 0.9e-3, 0.0}, {0.3e-3, 0.25e-3, 0.8e-3}};
  Vec3 x[4];
  Vec3 v[4] = {{.1, .2, -.1}, {.3, -.2, .05}, {-.15, .1, .2}, {.05, .25, -.3}};
  ShapeGradients shape = shape_gradients(reference);

  explicit Example(const Sym3& stretch = {1.002, .9985, 1.001, .0007, -.0003, .0005}) {
    for (int k = 0; k < 4; ++k) x[k] = turned(stretch * reference[k]) + Vec3{3e-3, -1e-3, 2e-3};
  }
  void forces(const ElasticTetrahedron& law, double eta, Vec3 (&f)[4]) const {
    const Deformation d = deformation(shape, x);
    corner_forces(shape, shape.volume(), law.piola(d, eta, deformation_rate(shape, d, v)), f);
  }
  double energy(const ElasticTetrahedron& law) const {
    return shape.volume() * law.energy(deformation(shape, x));
  }
};

void expect_near(const Vec3& value, const Vec3& expected, double tolerance) {
  EXPECT_NEAR(value.x, expected.x, tolerance);
  EXPECT_NEAR(value.y, expected.y, tolerance);
  EXPECT_NEAR(value.z, expected.z, tolerance);
}

TEST(ElasticTetrahedron, gives_the_reference_values) {
  const Example e;
  const ElasticTetrahedron law = law_of();
  const Deformation d = deformation(e.shape, e.x);
  EXPECT_NEAR(e.shape.volume(), 1.2e-10, 1e-24);
  EXPECT_NEAR(d.jacobian, 1.0014966656949997, 1e-14);
  const Sym3 s = law.stress(d);
  EXPECT_NEAR(s.xx, 72.13876037985e6, 1e-3);
  EXPECT_NEAR(s.yy, 8.873336208538e6, 1e-3);
  EXPECT_NEAR(s.zz, 98.77323520831e6, 1e-3);
  EXPECT_NEAR(s.yz, -6.379279308138e6, 1e-3);
  EXPECT_NEAR(s.xz, -16.37341423342e6, 1e-3);
  EXPECT_NEAR(s.xy, 83.26032986045e6, 1e-3);
  EXPECT_NEAR(e.energy(law), 2.8879599774e-5, 1e-14);
  Vec3 f[4];
  e.forces(law, 0.0, f);
  expect_near(f[0], {16.96316844344, 7.983450608844, 3.629908598357}, 1e-9);
  expect_near(f[1], {-11.06545333373, -9.387199028852, 8.670614637516}, 1e-9);
  expect_near(f[2], {-5.985550927642, 4.095064999743, 1.155388077771}, 1e-9);
  expect_near(f[3], {0.08783581793195, -2.691316579735, -13.45591131364}, 1e-9);
}

TEST(ElasticTetrahedron, gives_the_reference_values_with_viscosity) {
  const Example e;
  const double eta = 25219.040425836985;
  Vec3 f[4];
  e.forces(law_of(), eta, f);
  expect_near(f[0], {16.53632126972, 7.238651425290, 4.007710846638}, 1e-9);
  expect_near(f[1], {-11.85931387400, -8.029200620211, 8.131325795341}, 1e-9);
  expect_near(f[2], {-4.816239095867, 4.468600302272, -.2107045196410}, 1e-9);
  expect_near(f[3], {.1392317001497, -3.678051107351, -11.92833212234}, 1e-9);
  const Deformation d = deformation(e.shape, e.x);
  const Sym3 rate = deformation_rate(e.shape, d, e.v);
  EXPECT_NEAR(eta * contract(rate, rate) * d.jacobian * e.shape.volume(), 1.879796424010, 1e-11);
}

TEST(ElasticTetrahedron, bears_the_stress_in_situ) {
  const Example e({1.0, 1.0, 1.0, 0.0, 0.0, 0.0});
  Example still = e;
  for (int k = 0; k < 4; ++k) still.x[k] = still.reference[k];
  Vec3 f[4];
  still.forces(law_of({-10e6, -20e6, -30e6, 0.0, 0.0, 4e6}), 0.0, f);
  expect_near(f[0], {-.7733333333333, -1.6533333333333, -2.15}, 1e-12);
  expect_near(f[1], {1.3066666666667, -1.0133333333333, -1.1}, 1e-12);
  expect_near(f[2], {-.5333333333333, 2.6666666666667, -1.25}, 1e-12);
  expect_near(f[3], {0.0, 0.0, 4.5}, 1e-12);
}

TEST(ElasticTetrahedron, feels_nothing_where_it_is_only_turned_and_moved) {
  const Example e({1.0, 1.0, 1.0, 0.0, 0.0, 0.0});
  Vec3 f[4];
  e.forces(law_of(), 0.0, f);
  for (const Vec3& force : f) EXPECT_LT(norm(force), 1e-13 * young * 1e-6);
}

TEST(ElasticTetrahedron, puts_forces_that_are_the_slope_of_its_energy) {
  const ElasticTetrahedron law = law_of({-10e6, -20e6, -30e6, 3e6, -2e6, 4e6});
  const Example e({1.05, 0.93, 1.08, 0.04, -0.03, 0.06});
  Vec3 f[4];
  e.forces(law, 0.0, f);
  Vec3 sum{}, moment{};
  double largest = 0.0;
  for (int k = 0; k < 4; ++k) {
    sum += f[k];
    moment += cross(e.x[k], f[k]);
    largest = std::max(largest, norm(f[k]));
  }
  EXPECT_LT(norm(sum), 1e-14 * largest);
  EXPECT_LT(norm(moment), 1e-13 * largest * 3e-3);
  const double h = 1e-8;
  for (int k = 0; k < 4; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      const auto energy_at = [&](double by) {
        Example moved = e;
        Vec3& x = moved.x[k];
        (axis == 0 ? x.x : axis == 1 ? x.y : x.z) += by;
        return moved.energy(law);
      };
      // Fourth-order central difference.
      const double slope =
          (8.0 * (energy_at(h) - energy_at(-h)) - (energy_at(2.0 * h) - energy_at(-2.0 * h))) /
          (12.0 * h);
      const double force = axis == 0 ? f[k].x : axis == 1 ? f[k].y : f[k].z;
      EXPECT_NEAR(-slope, force, 1e-6 * largest) << k << ' ' << axis;
    }
}

/// Transversely isotropic, with planes aslant.
ElasticTetrahedron bedded_law(const Sym3& preset = {}) {
  ElasticTetrahedron law = law_of(preset);
  law.planes.across = (1.0 / std::sqrt(14.0)) * Vec3{1.0, -2.0, 3.0};
  law.planes.pressed = -0.3 * law.lambda;
  law.planes.slid = -0.4 * law.shear;
  law.planes.bent = 0.5 * law.shear;
  return law;
}

/// Forces are the slope of the energy, with neither sum nor moment, and turn with the body.
TEST(ElasticTetrahedron, of_bedded_rock_puts_forces_that_are_the_slope_of_its_energy) {
  const ElasticTetrahedron law = bedded_law({-10e6, -20e6, -30e6, 3e6, -2e6, 4e6});
  const Example e({1.05, 0.93, 1.08, 0.04, -0.03, 0.06});
  Vec3 f[4], sum{}, moment{};
  e.forces(law, 0.0, f);
  double largest = 0.0;
  for (int k = 0; k < 4; ++k) {
    sum += f[k];
    moment += cross(e.x[k], f[k]);
    largest = std::max(largest, norm(f[k]));
  }
  EXPECT_LT(norm(sum), 1e-14 * largest);
  EXPECT_LT(norm(moment), 1e-13 * largest * 3e-3);
  const double h = 1e-8;
  for (int k = 0; k < 4; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      const auto energy_at = [&](double by) {
        Example moved = e;
        Vec3& x = moved.x[k];
        (axis == 0 ? x.x : axis == 1 ? x.y : x.z) += by;
        return moved.energy(law);
      };
      const double slope =
          (8.0 * (energy_at(h) - energy_at(-h)) - (energy_at(2.0 * h) - energy_at(-2.0 * h))) /
          (12.0 * h);
      const double force = axis == 0 ? f[k].x : axis == 1 ? f[k].y : f[k].z;
      EXPECT_NEAR(-slope, force, 1e-6 * largest) << k << ' ' << axis;
    }
}

/// S : C^-1 S / 2 is what a strain stores that brings a rock to that stress.
TEST(ElasticTetrahedron, of_bedded_rock_holds_the_energy_of_its_stress) {
  const ElasticTetrahedron law = bedded_law();
  const double s = 1e-7;
  const Sym3 e{3.0 * s, -1.0 * s, 0.5 * s, 2.0 * s, -0.7 * s, 1.2 * s};
  Deformation d;
  d.gradient = {{1.0 + e.xx, e.xy, e.xz}, {e.xy, 1.0 + e.yy, e.yz}, {e.xz, e.yz, 1.0 + e.zz}};
  d.cofactor = cofactors(d.gradient);
  d.jacobian = dot(d.gradient.a, d.cofactor.a);
  const Sym3 stress = law.stress(d);
  const double stored = 0.5 * contract(stress, e);
  EXPECT_NEAR(law.energy(d), stored, 1e-5 * stored);
  EXPECT_NEAR(law.planes.energy_of(stress, law.lambda, law.shear), stored, 1e-5 * stored);
}

TEST(ElasticTetrahedron, holds_next_to_nothing_where_rounding_alone_deforms_it) {
  const Example e({1.0, 1.0, 1.0, 0.0, 0.0, 0.0});
  Example still = e;
  for (int k = 0; k < 4; ++k) still.x[k] = still.reference[k] + Vec3{1.0, -2.0, 3.0};
  EXPECT_LT(std::abs(still.energy(law_of())), 1e-23 * young * still.shape.volume());
  for (const double x : {1e-12, -1e-5, 0.049, 0.051, -0.049, -0.3, 2.0}) {
    const long double exact = std::log1p(static_cast<long double>(x)) - static_cast<long double>(x);
    EXPECT_NEAR(log_less_linear(x), static_cast<double>(exact),
                4e-16 * (std::abs(x) < 0.05 ? x * x : 1.0 + std::abs(x)) + 2e-19 * std::abs(x))
        << x;
  }
}

/// mu e : e + lambda/2 (tr e)^2, whatever way the tetrahedron has turned.
TEST(ElasticTetrahedron, energy_of_the_least_strains_keeps_its_digits) {
  const ElasticTetrahedron law = law_of();
  const double s = 1e-9;
  const Sym3 e{3.0 * s, -1.0 * s, 0.5 * s, 2.0 * s, -0.7 * s, 1.2 * s};
  const double sum = trace(e);
  const double expected = law.shear * contract(e, e) + 0.5 * law.lambda * sum * sum;
  for (int turn = 0; turn < 12; ++turn) {
    const double angle = turn * pi / 6.0, c = std::cos(angle), n = std::sin(angle);
    const auto turned = [&](const Vec3& v) {  // about z, then about x
      const Vec3 u{c * v.x - n * v.y, n * v.x + c * v.y, v.z};
      return Vec3{u.x, c * u.y - n * u.z, n * u.y + c * u.z};
    };
    Deformation d;
    d.gradient = {turned({1.0 + e.xx, e.xy, e.xz}), turned({e.xy, 1.0 + e.yy, e.yz}),
                  turned({e.xz, e.yz, 1.0 + e.zz})};
    d.cofactor = cofactors(d.gradient);
    d.jacobian = dot(d.gradient.a, d.cofactor.a);
    EXPECT_NEAR(law.energy(d), expected, 1e-6 * expected) << turn;
  }
}

}  // namespace elastic_tetrahedron_test
}  // namespace breccia::fdem3
