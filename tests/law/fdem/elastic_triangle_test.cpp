// The stress of a deformable triangle: reference values, rotation, energy, patch of triangles.

#include "fdem/laws/elastic_triangle.hpp"

#include <gtest/gtest.h>

#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace elastic_triangle_test {

using testing::rotated;
using testing::Scene;

constexpr double young = 60e9, poisson = 0.25;

ElasticTriangle law_of(bool plane_stress) {
  ElasticTriangle law;
  law.lambda = plane_lambda(young, poisson, plane_stress);
  law.shear = shear_modulus(young, poisson);
  return law;
}

/// The reference triangle: stretched, turned by 30 degrees and moved.
struct Example {
  Vec2 reference[3] = {{0.0, 0.0}, {1e-3, 0.0}, {0.2e-3, 0.9e-3}};
  Vec2 x[3], v[3] = {};
  Mat2 shape_inverse = inverse(columns(reference[1] - reference[0], reference[2] - reference[0]));

  explicit Example(const Mat2& stretch = {1.002, 0.0005, 0.0005, 0.9985}) {
    for (int k = 0; k < 3; ++k)
      x[k] = rotated(stretch * reference[k], pi / 6.0) + Vec2{3e-3, -1e-3};
  }
  Deformation<double> now() const { return deformation(shape_inverse, x, v); }
};

TEST(ElasticTriangle, presses_across_the_plane_as_hooke_says_where_strains_are_small) {
  const Example e({1.0 + 1e-6, 2e-7, 2e-7, 1.0 - 4e-6});
  const ElasticTriangle law = law_of(false);
  const Sym2 s = law.stress(e.now(), 0.0);
  EXPECT_NEAR(law.stress_across(e.now()) / (poisson * (s.xx + s.yy)), 1.0, 1e-5);
}

TEST(ElasticTriangle, has_the_reference_stress_and_forces_in_plane_strain) {
  const Example e;
  EXPECT_NEAR(e.now().jacobian, 1.00049675, 1e-12);
  const Sym2 s = law_of(false).stress(e.now(), 0.0);
  EXPECT_NEAR(s.xx, 45.204200097e6, 1e-3);
  EXPECT_NEAR(s.xy, 84.725233192e6, 1e-3);
  EXPECT_NEAR(s.yy, 2.7838840756e6, 1e-3);
  Vec2 f[3];
  corner_forces(s, e.x, f);
  EXPECT_NEAR(f[0].x, 56946.484885, 1e-5);
  EXPECT_NEAR(f[0].y, 17575.692333, 1e-5);
  EXPECT_NEAR(f[1].x, -31530.038313, 1e-5);
  EXPECT_NEAR(f[1].y, -37610.186704, 1e-5);
  EXPECT_NEAR(f[2].x, -25416.446572, 1e-5);
  EXPECT_NEAR(f[2].y, 20034.494371, 1e-5);
}

TEST(ElasticTriangle, has_the_reference_stress_in_plane_stress) {
  const Sym2 s = law_of(true).stress(Example().now(), 0.0);
  EXPECT_NEAR(s.xx, 41.231186649e6, 1e-3);
  EXPECT_NEAR(s.xy, 84.725233192e6, 1e-3);
  EXPECT_NEAR(s.yy, -1.1891293722e6, 1e-3);
}

/// Hooke's law of the plane problem, and its error, which is of second order.
TEST(ElasticTriangle, is_hooke_s_law_to_first_order) {
  for (const bool plane_stress : {true, false}) {
    double error[2];
    for (int i = 0; i < 2; ++i) {
      const double e = i == 0 ? 1e-3 : 1e-4;
      Example example({1.0 + e, 0.0, 0.0, 1.0 - 0.5 * e});
      for (int k = 0; k < 3; ++k)
        example.x[k] = {(1.0 + e) * example.reference[k].x,
                        (1.0 - 0.5 * e) * example.reference[k].y};
      const double modulus = plane_stress ? young / (1.0 - poisson * poisson)
                                          : young / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
      const double expected = plane_stress ? modulus * (e - poisson * 0.5 * e)
                                           : modulus * ((1.0 - poisson) * e - poisson * 0.5 * e);
      error[i] = std::abs(law_of(plane_stress).stress(example.now(), 0.0).xx - expected) / expected;
      EXPECT_LT(error[i], 3.0 * e);
    }
    EXPECT_NEAR(error[0] / error[1], 10.0, 0.5);
  }
}

TEST(ElasticTriangle, feels_no_rotation) {
  for (int i = 1; i < 12; ++i) {
    Example e;
    for (int k = 0; k < 3; ++k) e.x[k] = rotated(e.reference[k], i * pi / 6.0);
    const Sym2 s = law_of(true).stress(e.now(), 0.0);
    EXPECT_LT(std::abs(s.xx) + std::abs(s.yy) + std::abs(s.xy), 1e-14 * young);
  }
}

/// A triangle in single precision, from what is taken in double of its corners.
Deformation<Single> in_single(const Example& e, bool bedded) {
  const TriangleStrains<double> taken[1] = {strains(e.shape_inverse, e.x, e.v, bedded)};
  return Deformation<Single>(narrowed_record<Single>(taken));
}
ElasticLaw<Single> in_single(const ElasticTriangle& law) {
  const ElasticLaw<float> f = in_floats(law);
  return {Single(f.lambda),
          Single(f.shear),
          {Single(f.preset.xx), Single(f.preset.yy), Single(f.preset.xy)},
          Single(f.tilt),
          Single(f.bend),
          Single(f.planes)};
}

/// However small its strain is and however far it has turned, single precision loses some
/// roundings, 2^-24 each, of the stresses that add up: of strain, in situ, of bedding. Of F alone
/// it would lose 2^-24 of E.
TEST(ElasticTriangle, in_single_precision_loses_a_few_roundings_of_its_stress) {
  constexpr double some = 16 * 0x1p-24;
  for (const bool preset : {false, true})
    for (const bool bedded : {false, true}) {
      ElasticTriangle law = law_of(false);
      if (preset) law.preset = {-20e6, -8e6, 3e6};
      if (bedded) law.tilt = -4e9, law.bend = 3e9, law.planes = 0.7;
      for (const double strain : {1e-9, 1e-6, 1e-3, 0.2})
        for (int turn = 0; turn < 12; ++turn) {
          Example e({1.0 + strain, 0.2 * strain, 0.3 * strain, 1.0 - 0.6 * strain});
          for (Vec2& x : e.x) x = rotated(x, turn * pi / 6.0 + 0.1);
          const Sym2 exact = law.stress(e.now(), 0.0);
          const Sym2Of<Single> s =
              in_single(law).stress(in_single(e, bedded), constant<Single>(0.0));
          const double size = (3.0 * (law.lambda + 2.0 * law.shear) + 4.0 * std::abs(law.tilt) +
                               4.0 * std::abs(law.bend)) *
                                  strain +
                              (preset ? 40e6 : 0.0);
          EXPECT_NEAR(widened(s.xx), exact.xx, some * size) << strain << ", turned " << turn;
          EXPECT_NEAR(widened(s.yy), exact.yy, some * size) << strain << ", turned " << turn;
          EXPECT_NEAR(widened(s.xy), exact.xy, some * size) << strain << ", turned " << turn;
        }
    }
}

TEST(ElasticTriangle, feels_no_rotation_in_single_precision) {
  for (int i = 1; i < 12; ++i) {
    Example e;
    for (int k = 0; k < 3; ++k) e.x[k] = rotated(e.reference[k], 0.3 + i * pi / 6.0);
    const Sym2Of<Single> s =
        in_single(law_of(true)).stress(in_single(e, false), constant<Single>(0.0));
    EXPECT_LT(abs(widened(s.xx)) + abs(widened(s.yy)) + abs(widened(s.xy)), 1e-14 * young);
  }
}

/// Forces are minus the gradient of the energy, with and without an in-situ stress.
TEST(ElasticTriangle, forces_are_the_gradient_of_its_energy) {
  for (const bool preset : {false, true}) {
    Example e({1.05, 0.02, 0.01, 0.93});
    ElasticTriangle law = law_of(false);
    if (preset) law.preset = {-3e9, 2e9, 1e9};
    Vec2 f[3];
    corner_forces(law.stress(e.now(), 0.0), e.x, f);
    const double area = 0.5 / determinant(e.shape_inverse), d = 1e-9;
    for (int k = 0; k < 3; ++k)
      for (double Vec2::*c : {&Vec2::x, &Vec2::y}) {
        Example up = e, down = e;
        up.x[k].*c += d;
        down.x[k].*c -= d;
        const double slope = area * (law.energy(up.now()) - law.energy(down.now())) / (2.0 * d);
        EXPECT_NEAR(f[k].*c, -slope, 1e-7 * young * 1e-3);
      }
  }
}

/// By the logarithm that every device has, and close to that of a library; inside out it has none.
TEST(ElasticTriangle, energy_holds_for_any_change_of_area) {
  const ElasticTriangle law = law_of(false);
  for (const double stretch : {0.2, 0.9, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.1, 5.0}) {
    const Deformation<double> d{{stretch, 0.0, 0.0, 1.0}, {}, stretch};
    const double log_j = std::log(stretch);
    EXPECT_NEAR(law.energy(d),
                0.5 * law.shear * (stretch * stretch - 1.0 - 2.0 * log_j) +
                    0.25 * law.lambda * (stretch * stretch - 1.0 - 2.0 * log_j),
                4e-15 * (law.shear + law.lambda) * std::max(1.0, stretch * stretch));
  }
  EXPECT_TRUE(std::isnan(law.energy({{-1.0, 0.0, 0.0, 1.0}, {}, -1.0})));
}

/// Near rest, too, and whatever way the triangle has turned: mu e : e + lambda/2 (tr e)^2 of a
/// strain e of 1e-9, of which numbers near 1 keep seven digits.
TEST(ElasticTriangle, energy_of_the_least_strains_keeps_its_digits) {
  const ElasticTriangle law = law_of(false);
  const double s = 1e-9;
  const Sym2 strain{3.0 * s, -1.0 * s, 2.0 * s};
  const double sum = strain.xx + strain.yy;
  const double expected = law.shear * contract(strain, strain) + 0.5 * law.lambda * sum * sum;
  for (int turn = 0; turn < 12; ++turn) {
    const double angle = turn * pi / 6.0;
    const Vec2 first = rotated({1.0 + strain.xx, strain.xy}, angle),
               second = rotated({strain.xy, 1.0 + strain.yy}, angle);
    const Mat2 f = columns(first, second);
    EXPECT_NEAR(law.energy({f, {}, determinant(f)}), expected, 1e-6 * expected) << turn;
  }
}

/// A rock under stress in situ holds the energy of Hooke's law, and none where that has gone.
TEST(ElasticTriangle, energy_of_a_stress_in_situ_is_that_of_its_strain) {
  for (const bool plane_stress : {true, false}) {
    ElasticTriangle law = law_of(plane_stress);
    const double scale = 1e-6;
    const Sym2 strain{-3.0 * scale, 1.0 * scale, 2.0 * scale};
    const double trace = strain.xx + strain.yy;
    law.preset = {law.lambda * trace + 2.0 * law.shear * strain.xx,
                  law.lambda * trace + 2.0 * law.shear * strain.yy, 2.0 * law.shear * strain.xy};
    const double held = 0.5 * contract(law.preset, strain);
    const Deformation<double> none{{1.0, 0.0, 0.0, 1.0}, {}, 1.0};
    EXPECT_NEAR(law.energy(none), held, 1e-12 * held);
    const Mat2 back{1.0 - strain.xx, -strain.xy, -strain.xy, 1.0 - strain.yy};
    EXPECT_NEAR(law.energy({back, {}, determinant(back)}), 0.0, 1e-4 * held);
  }
}

TEST(ElasticTriangle, viscosity_answers_the_rate_of_strain_and_no_spin) {
  Example e;
  for (int k = 0; k < 3; ++k) {
    e.x[k] = e.reference[k];
    e.v[k] = Mat2{3.0, 2.0, -1.0, 5.0} * e.x[k];
  }
  const Sym2 s = law_of(true).stress(e.now(), 7e6);
  EXPECT_NEAR(s.xx, 21e6, 1e-3);
  EXPECT_NEAR(s.yy, 35e6, 1e-3);
  EXPECT_NEAR(s.xy, 3.5e6, 1e-3);
}

/// A deformation that is linear over a mesh gives every triangle the same stress, and no force
/// inside.
TEST(ElasticTriangle, passes_the_patch_test_in_a_jittered_mesh) {
  Scene scene;
  scene.material(young, poisson);
  prepare::Mesh mesh = prepare::crossed_rectangle({{0.0, 0.0}, {1.0, 1.0}}, 0.125);
  prepare::jitter(mesh, 0.2, {1, 1}, {});
  scene.body("patch", mesh);
  World w = scene.world();
  const Mat2 f{1.001, 3e-4, -5e-4, 0.9995};
  testing::deform(w, [&](const Vec2& x) { return f * x; });
  evaluate_forces(w);
  const std::vector<Sym2> stress = stresses(w);
  for (const Sym2& s : stress) {
    EXPECT_NEAR(s.xx, stress[0].xx, 1e-12 * young);
    EXPECT_NEAR(s.yy, stress[0].yy, 1e-12 * young);
    EXPECT_NEAR(s.xy, stress[0].xy, 1e-12 * young);
  }
  EXPECT_GT(std::abs(stress[0].xx), 1e-4 * young);
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec2 x =
          scene.model
              .point[static_cast<std::size_t>(w.vertex[static_cast<std::size_t>(3 * t + k)])];
      if (std::max(std::abs(x.x), std::abs(x.y)) > 0.499) continue;
      EXPECT_LT(norm(w.triangles.force.data()[t].at[k]), 1e-12 * young);
    }
}

/// A full turn in 1e5 steps: rounding alone must not build up stress, nor open joints.
TEST(ElasticTriangle, and_joints_feel_nothing_of_a_full_turn) {
  Scene scene;
  scene.material(young, poisson).joints = "intrinsic";
  scene.body("body", prepare::equilateral_rectangle({{0.0, 0.0}, {2e-3, 2e-3}}, 1e-3));
  World w = scene.world();
  constexpr int steps = 100000;
  for (int i = 1; i <= steps; ++i) {
    testing::deform(w, [](const Vec2& x) { return rotated(x, 2.0 * pi / steps); });
    if (i % 5000 != 0) continue;
    evaluate_forces(w);
    for (const Sym2& s : stresses(w))
      EXPECT_LT(std::abs(s.xx) + std::abs(s.yy) + std::abs(s.xy), 1e-10 * young);
    for (const JointForce& f : w.joints.force.in_double.host())
      EXPECT_LT(norm(f.first) + norm(f.second), 1e-10 * young * 1e-3);
  }
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Index vertex = w.vertex[static_cast<std::size_t>(3 * t + k)];
      const Vec2 start = scene.model.point[static_cast<std::size_t>(vertex)];
      EXPECT_LT(norm(testing::nodes(w, t).at[k].position - start), 1e-10 * 1e-3);
    }
}

/// Free spin: the body does not wander and keeps its angular momentum, to rounding.
TEST(ElasticTriangle, a_free_body_spins_on_without_drift) {
  Scene scene;
  scene.material(1e9, poisson).joints = "intrinsic";
  scene.body("body", prepare::equilateral_rectangle({{0.0, 0.0}, {2.0, 2.0}}, 1.0));
  World w = scene.world();
  constexpr int steps = 20000;
  const double spin = 2.0 * pi / (steps * w.next_dt);
  testing::stir(w, [&](const Vec2& x) { return Vec2{-spin * x.y, spin * x.x}; });
  const auto moment = [&] {
    double sum = 0.0;
    for (Index t = 0; t < w.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k)
        sum += w.triangles.mass.data()[t] *
               cross(testing::nodes(w, t).at[k].position, testing::velocity_now(w, t, k));
    return sum;
  };
  const double before = moment();
  for (int i = 0; i < steps; ++i) step(w);
  // Joints act on corners that lie apart by their opening, rho (spin r)^2 h / p_f: their moment is
  // shear traction times that, of second order in the strain.
  const double strain = 2650.0 * spin * spin * 2.0 / 1e9;
  EXPECT_NEAR(moment() / before, 1.0, 10.0 * strain);
  const testing::Momentum p = testing::momentum(w);
  EXPECT_LT(norm(p.linear), 1e-11 * p.size);
}

}  // namespace elastic_triangle_test
}  // namespace breccia::fdem
