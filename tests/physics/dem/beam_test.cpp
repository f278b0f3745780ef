// Cantilevers of linked spheres: a link is a hinge in the middle of two elements with the bending
// stiffness K_r and the shear stiffness K_t, so every deflection is a finite sum.

#include <gtest/gtest.h>

#include "scene.hpp"

namespace breccia::dem {
namespace beam_test {

using testing::Scene;
using testing::state;

constexpr double radius = 0.01, spacing = 0.02;

/// n touching spheres beyond a held one; the last has half the mass, as the end of a bar has.
Scene cantilever(int links, double rolling_stiffness) {
  Scene s;
  MaterialConfig& m = s.material("c", "concrete", 30e9, 0.2, 2500.0);
  m.tensile_strength = m.cohesion = 1e15;
  m.rolling_limit = 1e9;
  m.rolling_stiffness = rolling_stiffness;
  s.config.time.safety = 0.8;
  const double mass = 2500.0 * 4.0 / 3.0 * pi * radius * radius * radius;
  for (int i = 0; i <= links; ++i) {
    const double share = i == links ? 0.5 : 1.0;
    s.element({i * spacing, 0.0, 0.0}, radius, share * mass, share * 0.4 * mass * radius * radius);
    if (i > 0) s.link(i - 1, i);
  }
  s.config.supports.push_back(
      {"clamp", "", {-1e-3, -1.0, -1.0}, {1e-3, 1.0, 1.0}, {"all"}, {}, 0.0});
  return s;
}

struct LinkStiffness {
  double shear, bending;
};
LinkStiffness stiffness_of(const World& w) {
  const double kt = w.concrete.groups[0].law.shear_ratio * w.concrete.stiffness.data()[0];
  return {kt, w.concrete.groups[0].law.rolling_ratio * kt * radius * radius};
}

/// Moves the tip sideways, lets everything come to rest and returns force over deflection there.
double tip_stiffness(Scene s, int links) {
  const double x = links * spacing, deflection = 1e-6 * x;
  s.config.local_damping = 0.6;
  s.config.supports.push_back(
      {"tip", "", {x - 1e-3, -1.0, -1.0}, {x + 1e-3, 1.0, 1.0}, {"z"}, {0.0, 0.0, 0.01}, 0.0});
  World w = s.world();
  while (state(w, links).position.z < deflection) step(w);
  w.motions.data()[0].velocity = {};
  for (int i = 0; i < 40'000; ++i) step(w);
  return -w.elements.force.data()[links].z / state(w, links).position.z;
}

TEST(Beam, of_n_links_has_the_stiffness_of_n_hinges_in_a_row) {
  // d_tip = P/(EI) (L^3/3 - L d^2/12) + n P/K_t with EI = K_r d: sum of ((i + 1/2) d)^2 P/K_r
  const int n = 20;
  const double length = n * spacing;
  const Scene s = cantilever(n, 1.0);
  const LinkStiffness k = stiffness_of(s.world());
  const double bending = k.bending * spacing;
  const double compliance =
      (std::pow(length, 3) / 3.0 - length * spacing * spacing / 12.0) / bending + n / k.shear;
  EXPECT_NEAR(tip_stiffness(s, n) * compliance, 1.0, 1e-8);
}

TEST(Beam, whose_links_shear_like_beams_has_the_stiffness_of_the_beam_at_any_length) {
  // K_t = 12 EI/d^3 makes the sum P L^3/(3 EI) exactly; with EI = beta_r K_t r^2 d and d = 2 r that
  // is beta_r = 1/3.
  for (const int n : {1, 3, 12}) {
    const Scene s = cantilever(n, 1.0 / 3.0);
    const double bending = stiffness_of(s.world()).bending * spacing;
    EXPECT_NEAR(tip_stiffness(s, n) * std::pow(n * spacing, 3) / (3.0 * bending), 1.0, 1e-8) << n;
  }
}

TEST(Beam, a_bar_of_steel_pushed_at_its_tip_deflects_as_timoshenko_says) {
  const int n = 10;
  Scene s;
  s.material("b", "steel", 200e9, 0.3, 7850.0).yield = 1e15;
  const double thin = 0.004, area = pi * thin * thin, second = 0.25 * area * thin * thin;
  for (int i = 0; i <= n; ++i) {
    const double mass = 7850.0 * area * spacing;
    s.element({i * spacing, 0.0, 0.0}, thin, mass,
              mass * (spacing * spacing / 12.0 + thin * thin / 4.0));
    if (i > 0) s.link(i - 1, i, LinkKind::steel);
  }
  s.config.supports.push_back(
      {"clamp", "", {-1e-3, -1.0, -1.0}, {1e-3, 1.0, 1.0}, {"all"}, {}, 0.0});
  const double length = n * spacing, shear = 200e9 / 2.6;
  const double expected = std::pow(length, 3) / (3.0 * 200e9 * second) +
                          length / (0.9 * shear * area);  // shear factor 0.9 of a disc
  EXPECT_NEAR(tip_stiffness(s, n) * expected, 1.0, 1e-8);
}

/// The first mode of a clamped-free Euler-Bernoulli beam, 1 at the tip.
double first_mode(double x) {
  const double a = 1.8751040687119611;
  const double ratio = (std::cos(a) + std::cosh(a)) / (std::sin(a) + std::sinh(a));
  const auto shape = [&](double s) {
    return std::cosh(a * s) - std::cos(a * s) - ratio * (std::sinh(a * s) - std::sin(a * s));
  };
  return shape(x) / shape(1.0);
}

/// First circular frequency over that of the beam, 3.5160153 sqrt(EI/(m/d)/L^4).
double relative_frequency(int links) {
  Scene s = cantilever(links, 1.0);
  std::vector<double> shape;
  for (int i = 0; i <= links; ++i) {
    shape.push_back(first_mode(static_cast<double>(i) / links));
    s.model.velocity[static_cast<std::size_t>(i)].z = 1e-4 * shape.back();
  }
  World w = s.world();
  const double bending = stiffness_of(w).bending * spacing, length = links * spacing;
  const double expected =
      3.5160153 * std::sqrt(bending / (s.model.mass[0] / spacing)) / (length * length);
  // Zero crossings of the part of the motion in the first mode.
  double before = 0.0, first = 0.0, last = 0.0;
  for (int crossings = 0; crossings < 7;) {
    step(w);
    double now = 0.0;
    for (int i = 0; i <= links; ++i)
      now += s.model.mass[static_cast<std::size_t>(i)] * shape[static_cast<std::size_t>(i)] *
             state(w, i).position.z;
    if (before * now < 0.0) {
      last = w.time - w.last_dt * now / (now - before);
      if (crossings == 0) first = last;
      ++crossings;
    }
    before = now;
  }
  return pi * 6.0 / (last - first) / expected;
}

TEST(Beam, the_first_frequency_converges_to_the_beam_s_with_the_square_of_the_spacing) {
  const double coarse = relative_frequency(10), middle = relative_frequency(20),
               fine = relative_frequency(40);
  EXPECT_NEAR(middle, 1.0, 0.01);
  EXPECT_NEAR((coarse - 1.0) / (middle - 1.0), 4.0, 0.4);
  EXPECT_NEAR((middle - 1.0) / (fine - 1.0), 4.0, 0.2);
}

}  // namespace beam_test
}  // namespace breccia::dem
