// The fracture energy that a material is given is what a notched specimen takes, whatever the size
// of its elements.

#include "prepare/packing/fracture_energy.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "confined_concrete.hpp"
#include "dem/observe.hpp"
#include "exec/error.hpp"
#include "prepare/packing/linking.hpp"
#include "specimen.hpp"

namespace breccia::dem {
namespace fracture_energy_test {

using testing::Specimen;

Specimen notched(int count, int seed, double energy) {
  Specimen s(count, {0.1, 0.1, 0.15});
  s.config.seed = seed;
  s.config.bodies[0].pack.compactness = 0.56;
  s.config.links.range = 1.443;
  breccia::testing::confine(s.material());
  s.material().fabric = "even";
  s.material().stiffness = "measured";
  s.material().fracture_energy = energy;
  return s;
}

/// Work that parts a prism with two notches, 25 mm each, less what is stored, over the ligament.
double work_of_fracture(Specimen s, double opening) {
  s.material().fracture_energy = 0.0;
  Model m = s.model();
  m.bulk[0].rupture_opening = opening;
  double mean = 0.0;
  for (const double r : m.radius) mean += r / static_cast<double>(m.size());
  prepare::drop_links(m, [&](const Model::Link& link) {
    const Vec3 a = m.position[static_cast<std::size_t>(link.a)];
    const Vec3 b = m.position[static_cast<std::size_t>(link.b)];
    const double x = a.x + a.z / (a.z - b.z) * (b.x - a.x);
    return a.z * b.z < 0.0 && std::fabs(x) >= 0.025;
  });
  const double half = 0.5 * s.size.z, layer = half - 1.5 * mean, speed = 0.02;
  s.config.supports = {
      {"top", "", {-1.0, -1.0, layer}, {1.0, 1.0, 1.0}, {"x", "y", "z"}, {0.0, 0.0, speed}, 0.0},
      {"bottom",
       "",
       {-1.0, -1.0, -1.0},
       {1.0, 1.0, -layer},
       {"x", "y", "z"},
       {0.0, 0.0, -speed},
       0.0}};
  for (std::size_t e = 0; e < m.position.size(); ++e)
    m.velocity[e].z = speed * m.position[e].z / half;
  World w = make_world(s.config, m, {});
  while (2.0 * speed * w.time < 2.4 * opening + 30e-6) step(w);
  const EnergyBalance e = balance(w);
  return (e.work + e.start - e.elastic - e.kinetic) / (0.05 * 0.1);
}

/// Seeds vary the energy by 7 %, the mean of three by 4 %; that of the packings which the opening
/// was found with likewise: 10 % is allowed.
TEST(FractureEnergy, of_a_notched_prism_is_that_of_the_case_at_three_sizes_of_elements) {
  for (const int count : {375, 900, 2250}) {
    const double opening = notched(count, 1, 100.0).model().bulk[0].rupture_opening;
    double mean = 0.0;
    for (int seed = 4; seed <= 6; ++seed)
      mean += work_of_fracture(notched(count, seed, 100.0), opening) / 3.0;
    std::printf("%d elements: u_2 %.3g m, %.4g J/m2\n", count, opening, mean);
    EXPECT_NEAR(mean, 100.0, 10.0) << count;
  }
}

/// Links that cross a crack take q T u_2 / 2 with q = 2.7; oblique ones open farther and slide.
/// Overlapping elements on both sides of the notch must not push: they spent 10,000 J/m2.
TEST(FractureEnergy, of_coarse_elements_is_that_of_their_links_alone) {
  Specimen s = notched(100, 1, 100.0);
  for (const double radius : {4e-3, 8e-3, 12e-3}) {
    const double opening = 60e-6;
    const double energy = prepare::notched_cube_energy(s.material(), s.config.contact,
                                                       {radius, 2.0, 0.62, 1.3}, opening);
    const double straight = 2.7 * 0.5 * s.material().tensile_strength * opening;
    std::printf("R %g m: %.4g J/m2, %.3g of the straight links'\n", radius, energy,
                energy / straight);
    EXPECT_GT(energy, straight) << radius;
    EXPECT_LT(energy, 2.5 * straight) << radius;
  }
}

TEST(FractureEnergy, too_small_for_the_elements_is_refused_with_the_largest_size) {
  Specimen s(60, {1.0, 1.0, 1.5});  // elements of some 0.3 m
  s.material().fracture_energy = 10.0;
  try {
    s.model();
    FAIL() << "not refused";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("fracture_energy = 10 J/m2 is too small for body specimen"),
              std::string::npos)
        << message;
    EXPECT_NE(message.find("elements of at most"), std::string::npos) << message;
  }
}

}  // namespace fracture_energy_test
}  // namespace breccia::dem
