// The facet of LDPM against closed answers and against an independent program's numbers.
//
// Units here: MPa, mm; strains in 1e-3; energies over volume in mJ/mm3 = MPa.

#include "dem/laws/ldpm_facet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace breccia::dem {
namespace ldpm_facet_test {

/// Concrete of public benchmarks of the model (max. grain 12 mm).
LdpmFacet benchmark() {
  return {60273.0,       0.25, 3.44, 500.0, 2.6, 0.4, 0.0,   150.0,  0.4 * 60273.0,
          0.1 * 60273.0, 4.0,  1.0,  5.0,   0.4, 0.0, 600.0, 60273.0};
}

/// A facet on an edge, led along straight legs.
class Facet {
 public:
  using Volumetric = std::function<double(double)>;
  explicit Facet(
      const LdpmFacet& by, double length = 10.0, Volumetric volumetric = [](double) { return 0.0; })
      : law(by), length_(length), volumetric_(std::move(volumetric)) {}

  /// @returns stress at the end of a leg
  Vec3 to(double normal, double m = 0.0, double l = 0.0, int steps = 20'000) {
    const Vec3 from = state.strain, goal{1e-3 * normal, 1e-3 * m, 1e-3 * l};
    for (int k = 1; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      const Vec3 strain = k == steps ? goal : from + share * (goal - from);
      const LdpmFacetState before = state;
      const auto spent = law.update(length_, strain, volumetric_(strain.x), state);
      const Vec3 de = state.strain - before.strain;
      work += 0.5 * dot(before.stress + state.stress, de);
      fracture += spent.fracture, plastic += spent.plastic, friction += spent.friction;
      least = std::min({least, spent.fracture, spent.plastic, spent.friction});
    }
    return state.stress;
  }
  double missing() const { return work - fracture - plastic - friction - law.stored(state.stress); }

  LdpmFacet law;
  LdpmFacetState state{};
  double work = 0.0, fracture = 0.0, plastic = 0.0, friction = 0.0, least = 0.0;

 private:
  double length_;
  Volumetric volumetric_;
};

void expect_stress(const Vec3& stress, double normal, double m, double l = 0.0) {
  EXPECT_NEAR(stress.x, normal, 2e-6 * (1.0 + std::fabs(normal)));
  EXPECT_NEAR(stress.y, m, 2e-6 * (1.0 + std::fabs(m)));
  EXPECT_NEAR(stress.z, l, 2e-6 * (1.0 + std::fabs(l)));
}

TEST(LdpmFacet, tension_softens_exponentially) {
  Facet f(benchmark());
  for (const auto& [strain, stress] : {std::pair{0.05, 3.01365},
                                       {0.1, 3.336000},
                                       {0.2, 3.105757},
                                       {0.5, 2.506060},
                                       {1.0, 1.752662},
                                       {2.0, 0.857258}})
    expect_stress(f.to(strain), stress, 0.0);
  EXPECT_NEAR(f.work, 3.709626e-3, 1e-8);
  EXPECT_NEAR(f.fracture, 3.703529e-3, 1e-8);
}

/// A wave front that has gone through many edges within few steps leaves such strains.
TEST(LdpmFacet, bears_strains_whose_squares_vanish) {
  for (const double strain : {1e-140, 1e-160, 1e-170, 1e-200, 1e-290})
    for (const double share : {0.0, 1e-60, 0.5}) {
      const LdpmFacet law = benchmark();
      LdpmFacetState state{};
      law.update(10.0, Vec3{strain, share * strain, 0.0}, 0.0, state);
      EXPECT_NEAR(state.stress.x / (law.young * strain), 1.0, 1e-9) << strain;
      EXPECT_NEAR(state.stress.y, law.shear_ratio * share * state.stress.x, 1e-9 * state.stress.x);
    }
}

/// F = 1 + 0.05 asinh(1e5) = 1.610304 at 1/s; slow, or unasked, it is 1.
TEST(LdpmFacet, strengths_grow_with_the_strain_rate_if_asked) {
  const double faster = 1.0 + 0.05 * std::asinh(1e5), dt = 1e-9;
  EXPECT_NEAR(faster, 1.610304, 1e-6);
  LdpmFacet law = benchmark();
  const auto peak_of = [&](const LdpmFacet& by, double step) {
    LdpmFacetState s{};
    double peak = 0.0;
    for (int k = 1; k <= 150'000; ++k) {
      by.update(10.0, Vec3{k * dt, 0.0, 0.0}, 0.0, s, step);
      peak = std::max(peak, s.stress.x);
    }
    return peak;
  };
  EXPECT_NEAR(peak_of(law, dt), 3.44, 2e-4);
  law.rate_factor = 0.05;
  EXPECT_NEAR(peak_of(law, 0.0), 3.44, 2e-4);
  EXPECT_NEAR(peak_of(law, dt), 3.44 * faster, 2e-4);

  // Softening from F s_0: s_b = F s_0 exp(-H_t <e - F s_0 / E_0> / (F s_0)).
  LdpmFacetState s{};
  for (int k = 1; k <= 500'000; ++k) law.update(10.0, Vec3{k * dt, 0.0, 0.0}, 0.0, s, dt);
  const double s0 = 3.44 * faster, hardening = 2.0 * 60273.0 / 49.0;
  EXPECT_NEAR(s.stress.x, s0 * std::exp(-hardening * (5e-4 - s0 / 60273.0) / s0), 1e-5);

  // Sliding under pressure: e' = sqrt(alpha) e_T' = 1/s.
  LdpmFacetState slid{};
  law.update(10.0, Vec3{-1e-3, 0.0, 0.0}, -1e-3, slid, 0.0);
  const double pressure = -slid.stress.x;
  LdpmFacet frictionless = law;
  frictionless.friction = 0.0;
  for (const LdpmFacet* by : {&law, &frictionless}) {
    LdpmFacetState t = slid;
    double last = 0.0;
    for (int k = 1; k <= 1'000'000; ++k) {
      const double e_t = 2e-3 * k * 1e-3 * 4.0;  // e / e' large against e_N
      by->update(10.0, Vec3{-1e-3, e_t, 0.0}, -1e-3, t, 4e-6);
      last = t.stress.y;
    }
    const double mu = by->friction;
    EXPECT_NEAR(last, 2.6 * 3.44 * faster + mu * 600.0 * (1.0 - std::exp(-pressure / 600.0)),
                1e-4 * last);
  }
}

TEST(LdpmFacet, rupture_spends_the_fracture_energy_whatever_the_length) {
  const LdpmFacet law = benchmark();
  // G_t = s_t^2 l_t / (2 E_0), over the volume A L
  const double energy =
      law.tensile_strength * law.tensile_strength * law.tensile_length / (2.0 * law.young);
  for (const double length : {5.0, 10.0, 100.0}) {
    Facet f(law, length);
    f.to(400.0 / length * 10.0, 0.0, 0.0, 400'000);
    EXPECT_NEAR(f.fracture * length, energy, 2e-4 * energy) << length;
  }
}

TEST(LdpmFacet, unloads_elastically_and_opens_again_from_where_it_closed) {
  Facet f(benchmark());
  f.to(1.0);
  expect_stress(f.to(0.98), 0.547202, 0.0);
  expect_stress(f.to(0.9), 0.0, 0.0);
  expect_stress(f.to(0.92), 1.205460, 0.0);
  expect_stress(f.to(1.1), 1.631697, 0.0);
}

TEST(LdpmFacet, opens_later_with_an_unloading_share) {
  LdpmFacet law = benchmark();
  law.unloading = 0.5;
  Facet f(law);
  expect_stress(f.to(1.0), 1.752662, 0.0);
  expect_stress(f.to(0.2), 0.0, 0.0);
  expect_stress(f.to(0.4), 0.0, 0.0);
  EXPECT_NEAR(f.to(0.5).x, 0.876369, 1e-3);
  EXPECT_NEAR(f.to(0.51).x, 1.479099, 1e-3);
}

TEST(LdpmFacet, mixed_opening_follows_the_direction_of_the_strain) {
  Facet f(benchmark());
  expect_stress(f.to(0.05, 0.05), 3.013650, 0.753413);
  expect_stress(f.to(0.1, 0.1), 3.317102, 0.829275);
  expect_stress(f.to(0.5, 0.5), 2.580810, 0.645202);
  expect_stress(f.to(1.0, 1.0), 1.885830, 0.471457);
  Facet g(benchmark());
  expect_stress(g.to(0.1, 0.3, -0.2), 3.028513, 2.271385, -1.514256);
  expect_stress(g.to(0.5, 1.5, -1.0), 2.475524, 1.856643, -1.237762);
}

TEST(LdpmFacet, shear_without_pressure_is_plastic_at_the_cohesion) {
  Facet f(benchmark());
  expect_stress(f.to(0.0, 0.3), 0.0, 4.520475);
  expect_stress(f.to(0.0, 0.6), 0.0, 8.944);
  expect_stress(f.to(0.0, 1.0), 0.0, 8.944);
  expect_stress(f.to(0.0, -1.0), 0.0, -8.944);
  EXPECT_NEAR(f.friction, 1.090544e-2, 1e-8);
  Facet g(benchmark());
  g.to(1e-3);
  expect_stress(g.to(1e-3, 0.6), 0.059108, 8.866215);
  expect_stress(g.to(1e-3, 2.0), 0.017751, 8.875284);
}

TEST(LdpmFacet, confined_compression_hardens_and_stiffens) {
  Facet f(benchmark(), 10.0, [](double e) { return e; });
  expect_stress(f.to(-2.0), -120.546, 0.0);
  expect_stress(f.to(-5.0), -210.546, 0.0);
  expect_stress(f.to(-10.0), -331.093809, 0.0);
  expect_stress(f.to(-20.0), -687.446194, 0.0);
  expect_stress(f.to(-19.0), -627.173194, 0.0);
  EXPECT_NEAR(f.plastic, 2.950774, 1e-5);
}

TEST(LdpmFacet, unconfined_compression_has_a_plateau) {
  Facet f(benchmark(), 10.0, [](double e) { return e / 3.0; });
  for (const auto& [strain, stress] : {std::pair{-2.0, -120.546},
                                       {-5.0, -150.0},
                                       {-10.0, -157.969838},
                                       {-20.0, -188.576366},
                                       {-30.0, -218.864651},
                                       {-60.0, -331.597391}})
    expect_stress(f.to(strain), stress, 0.0);
  Facet still(benchmark());
  expect_stress(still.to(-5.0), -150.0, 0.0);
  expect_stress(still.to(-20.0), -150.0, 0.0);
  Facet swollen(benchmark(), 10.0, [](double) { return 1e-3; });
  expect_stress(swollen.to(-2.0), -120.546, 0.0);
  expect_stress(swollen.to(-5.0), -150.0, 0.0);
}

TEST(LdpmFacet, denser_concrete_unloads_stiffer) {
  LdpmFacet law = benchmark();
  law.densified = 1.81 * law.young;
  Facet f(law, 10.0, [](double e) { return e; });
  expect_stress(f.to(-10.0), -331.093809, 0.0);
  EXPECT_NEAR(law.stored(f.state.stress), 0.5859532, 1e-7);
  expect_stress(f.to(-9.5), -276.546744, 0.0);
  expect_stress(f.to(-8.0), -129.505828, 0.0);
  expect_stress(f.to(-6.0), -8.959828, 0.0);
  EXPECT_NEAR(f.missing(), 0.0, 1e-12 * f.work);
}

TEST(LdpmFacet, friction_grows_with_pressure_and_changes_direction) {
  Facet f(benchmark(), 10.0, [](double e) { return e; });
  expect_stress(f.to(-1.0), -60.273, 0.0);
  expect_stress(f.to(-1.0, 2.0), -60.273, 30.1365);
  expect_stress(f.to(-1.0, 4.0), -60.273, 31.881805);
  const Vec3 turned = f.to(-1.0, 4.0, 2.0);
  EXPECT_NEAR(turned.y, 21.526967, 2e-3);
  EXPECT_NEAR(turned.z, 23.516786, 2e-3);
  const Vec3 back = f.to(-1.0, 0.0, 2.0);
  EXPECT_NEAR(back.y, -27.943441, 2e-3);
  EXPECT_NEAR(back.z, 15.349711, 2e-3);
}

TEST(LdpmFacet, opening_turns_the_stress_into_the_direction_of_the_strain) {
  Facet f(benchmark(), 10.0, [](double e) { return e; });
  f.to(-1.0);
  f.to(-1.0, 4.0);
  expect_stress(f.to(-0.001, 4.0), -0.060273, 8.968108);
  expect_stress(f.to(0.001, 4.0), 0.008849, 8.849127);
  expect_stress(f.to(0.1, 4.0), 0.733595, 7.335952);
}

/// Concrete of the public single tetrahedra, on an edge of 1 mm.
TEST(LdpmFacet, of_the_single_tetrahedra_opens_and_closes_with_the_error_of_one_step) {
  LdpmFacet law = benchmark();
  law.young = law.densified = 30000.0;
  law.shear_ratio = 0.2;
  law.tensile_strength = 3.0;
  law.tensile_length = 250.0;
  law.strength_ratio = 2.5;
  law.softening_exponent = 0.2;
  law.yield = 120.0;
  law.hardening = 0.33 * law.young;
  law.final_hardening = 0.1 * law.young;
  law.compaction_strain = 3.0;
  law.deviatoric_start = 0.5;
  Facet f(law, 1.0);
  expect_stress(f.to(0.1), 3.0, 0.0);
  expect_stress(f.to(1.0), 2.790786, 0.0);
  expect_stress(f.to(20.0), 0.606663, 0.0);
  expect_stress(f.to(10.0), 0.0, 0.0);
  // The step that closes it pulls E_0 de into compression: 20,000 steps of 5e-7.
  EXPECT_NEAR(f.to(0.0).x, -0.015, 1e-6);
}

/// The function called only where pores collapse gives what the number does.
TEST(LdpmFacet, asks_for_the_volumetric_strain_where_pores_collapse) {
  const LdpmFacet law = benchmark();
  LdpmFacetState given{}, asked{};
  int times = 0;
  for (int k = 0; k < 400; ++k) {
    const double normal = -5e-3 * std::sin(0.02 * k);
    const auto volumetric = [&] { return ++times, 0.6 * normal; };
    law.update(10.0, Vec3{normal, 0.1 * normal, 0.0}, 0.6 * normal, given);
    const int before = times;
    law.update(10.0, Vec3{normal, 0.1 * normal, 0.0}, volumetric, asked);
    EXPECT_EQ(asked.stress.x, given.stress.x) << k;
    if (given.stress.x > -law.yield) {
      EXPECT_EQ(times, before) << k;
    }
  }
  EXPECT_GT(times, 50);
}

TEST(LdpmFacet, random_walks_lose_no_energy_and_give_none_back) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int walk = 0; walk < 50; ++walk) {
    LdpmFacet law = benchmark();
    if (walk % 2 == 1) law.densified = 1.81 * law.young;
    Facet f(law, 10.0, [walk](double e) { return 0.1 * (walk % 8) * e; });
    Vec3 at{};
    for (int leg = 0; leg < 30; ++leg) {
      at += Vec3{2.0 * normal(random), normal(random), normal(random)};
      f.to(at.x, at.y, at.z, 2'000);
    }
    EXPECT_NEAR(f.missing(), 0.0, 1e-12 * (std::fabs(f.work) + 1.0)) << walk;
    EXPECT_GT(f.least, -1e-5) << walk;
  }
}

TEST(Elementary, functions_are_those_of_the_library_to_rounding) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < 20'000; ++k) {
    const double x = 100.0 * unit(random) - 70.0, y = unit(random), z = std::pow(10.0, -60.0 * y);
    EXPECT_NEAR(exponential(x) / std::exp(x), 1.0, 1e-15);
    EXPECT_NEAR(arc_tangent(y), std::atan(y), 1e-15);
    EXPECT_NEAR(logarithm(z), std::log(z), 1e-15 * (1.0 - std::log(z)));
    EXPECT_NEAR(power_of(y, 0.4), std::pow(y, 0.4), 1e-14);
  }
  EXPECT_EQ(exponential(0.0), 1.0);
  EXPECT_EQ(logarithm(1.0), 0.0);
  EXPECT_EQ(arc_tangent(0.0), 0.0);
}

/// Facets that soften, slide and rest, in any mixture: what decays has the bits of each alone.
TEST(LdpmFacet, what_decays_side_by_side_has_the_bits_of_each_alone) {
  using Step = LdpmFacet::Step<double>;
  const LdpmFacet law = benchmark();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  LdpmFacetState states[4] = {};
  int together = 0, soften = 0, slide = 0;
  for (int k = 0; k < 5'000; ++k) {
    Step steps[4];
    for (int j = 0; j < 4; ++j) {
      const Vec3 strain = states[j].strain + 2e-4 * Vec3{unit(random), unit(random), unit(random)};
      law.begin(10.0, strain, strain.x, states[j], 0.0, steps[j]);
      soften += steps[j].softens;
      slide += steps[j].slides;
    }
    const bool softens =
        steps[0].softens || steps[1].softens || steps[2].softens || steps[3].softens;
    const auto four = [&](const auto& of) {
      using Item = decltype(of(steps[0]));
      return Two<Two<Item>>{{of(steps[0]), of(steps[1])}, {of(steps[2]), of(steps[3])}};
    };
    const Two<Two<double>> decay =
        law.decay_of(softens, four([](const Step& s) { return s.strain.x > 0.0; }),
                     four([](const Step& s) { return s.half_tangent; }),
                     four([](const Step& s) { return s.exponent; }));
    const double of[] = {decay.one.one, decay.one.other, decay.other.one, decay.other.other};
    for (int j = 0; j < 4; ++j) {
      if (steps[j].decays()) {
        EXPECT_EQ(of[j], law.decay_of(steps[j])) << "step " << k << ", facet " << j;
        together += softens && !steps[j].softens;
      }
      law.end(steps[j], law.decay_of(steps[j]), states[j]);
    }
  }
  EXPECT_GT(soften, 1'000);
  EXPECT_GT(slide, 1'000);
  EXPECT_GT(together, 100);
}

}  // namespace ldpm_facet_test
}  // namespace breccia::dem
