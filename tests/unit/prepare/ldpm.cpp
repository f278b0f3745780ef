// Geometry of the lattice discrete particle model: mix, particles, tetrahedra, facets, cells.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/ldpm/particles.hpp"
#include "prepare/ldpm/tessellation.hpp"

namespace breccia::prepare {
namespace ldpm_test {

using breccia::at;  // of an index, beside that of a mesh

const MixDesign mix{};  // 6 to 12 mm
const Container cube{.shape = Container::Shape::box, .size = {0.05, 0.05, 0.05}};

struct Geometry {
  LdpmParticles particles;
  std::vector<double> diameter;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<LdpmFacet> facets;

  explicit Geometry(const Container& body, std::uint64_t seed = 1)
      : particles(place_particles(body, mix, {seed, 0})), diameter(particles.diameter) {
    for (double& d : diameter)
      if (d == 0.0) d = surface_diameter * mix.smallest;
    tetrahedra = tetrahedra_of(particles.position, mix.smallest);
    facets = facets_of(particles.position, diameter, tetrahedra);
  }
  double volume_of(const Tetrahedron& t) const {
    const auto& x = particles.position;
    return std::abs(six_volumes(x[at(t[0])], x[at(t[1])], x[at(t[2])], x[at(t[3])])) / 6.0;
  }
};

TEST(LdpmGeometry, grains_follow_fullers_curve_and_fill_their_share) {
  EXPECT_NEAR(mix.aggregate(), 1.0 - 0.1 - 0.1575 - 0.03, 1e-12);
  EXPECT_NEAR(mix.placed(), (1.0 - std::sqrt(0.5)) * mix.aggregate(), 1e-12);
  const double volume = 0.01;
  const auto diameters = grain_diameters(mix, volume, {3, 0});
  EXPECT_TRUE(std::is_sorted(diameters.rbegin(), diameters.rend()));
  double filled = 0.0, below = 0.0;
  for (const double d : diameters) {
    EXPECT_GE(d, mix.smallest);
    EXPECT_LE(d, mix.largest);
    filled += pi / 6.0 * d * d * d;
    if (d < 9e-3) below += pi / 6.0 * d * d * d;
  }
  EXPECT_NEAR(filled / (mix.placed() * volume), 1.0, 1e-3);
  const double share = (std::sqrt(9.0 / 12.0) - std::sqrt(0.5)) / (1.0 - std::sqrt(0.5));
  EXPECT_NEAR(below / filled, share, 0.02);
}

/// A quarter of the aggregate passes 8 mm, half of the rest 12 mm.
Grading sieved() {
  return {{4e-3, 8e-3, 12e-3, 16e-3}, {0.0, 0.25, 0.625, 1.0}};
}

TEST(LdpmGeometry, grains_follow_a_sieve_curve_and_fill_their_share) {
  MixDesign m = mix;
  m.smallest = 6e-3, m.largest = 16e-3, m.curve = sieved();
  EXPECT_NEAR(m.placed(), (1.0 - 0.125) * m.aggregate(), 1e-12);
  const double volume = 0.03;
  double filled = 0.0, below_8 = 0.0, below_12 = 0.0, below_14 = 0.0;
  for (const double d : grain_diameters(m, volume, {3, 0})) {
    EXPECT_GE(d, m.smallest * (1.0 - 1e-12));
    EXPECT_LE(d, m.largest * (1.0 + 1e-12));
    const double grain = pi / 6.0 * d * d * d;
    filled += grain;
    if (d < 8e-3) below_8 += grain;
    if (d < 12e-3) below_12 += grain;
    if (d < 14e-3) below_14 += grain;
  }
  EXPECT_NEAR(filled / (m.placed() * volume), 1.0, 1e-3);
  EXPECT_NEAR(below_8 / filled, 0.125 / 0.875, 0.01);
  EXPECT_NEAR(below_12 / filled, 0.5 / 0.875, 0.02);
  EXPECT_NEAR(below_14 / filled, 0.6875 / 0.875, 0.02);
}

/// Sieves that lie close together on Fuller's curve give the grains that Fuller's formula gives.
TEST(LdpmGeometry, many_sieves_on_fullers_curve_give_its_grains) {
  Grading fuller{{0.0}, {0.0}};
  for (int k = 0; k <= 800; ++k) {
    const double d = 4e-3 + 1e-5 * k;
    fuller.sieves.push_back(d);
    fuller.passing.push_back(k == 800 ? 1.0 : std::sqrt(d / 12e-3));
  }
  fuller.sieves[0] = 1e-3;
  ASSERT_EQ(fuller.problem(), "");
  const Grading grains = fuller.part(6e-3, 12e-3);
  ASSERT_EQ(grains.problem(), "");
  const double span = 1.0 - std::pow(0.5, 2.5);
  for (const double p : {0.0, 0.1, 0.37, 0.5, 0.9, 0.99, 0.9999})
    EXPECT_NEAR(grains.diameter_at(p), 6e-3 * std::pow(1.0 - p * span, -0.4), 1e-8) << p;
}

TEST(LdpmGeometry, a_part_of_a_sieve_curve_is_a_curve) {
  const Grading all = sieved(), part = all.part(6e-3, 14e-3);
  EXPECT_EQ(part.sieves, (std::vector<double>{6e-3, 8e-3, 12e-3, 14e-3}));
  for (const double d : {6e-3, 7e-3, 8e-3, 11e-3, 12e-3, 13e-3, 14e-3})
    EXPECT_NEAR(part.passes(d), (all.passes(d) - 0.125) / (0.8125 - 0.125), 1e-12) << d;
  EXPECT_EQ(all.passes(1e-3), 0.0);
  EXPECT_EQ(all.passes(1.0), 1.0);
}

TEST(LdpmGeometry, cement_follows_from_the_ratios_of_water_and_aggregate) {
  EXPECT_NEAR(cement_of(2338.0, 0.5, 5.92), 315.1, 0.1);
}

TEST(LdpmGeometry, grains_keep_off_each_other_and_off_the_surface) {
  const LdpmParticles p = place_particles(cube, mix, {1, 0});
  const auto count = static_cast<Index>(p.position.size());
  EXPECT_GT(p.on_surface, 200);
  EXPECT_GT(count - p.on_surface, 60);
  for (Index i = p.on_surface; i < count; ++i) {
    EXPECT_TRUE(cube.holds(p.position[at(i)], 0.5 * p.diameter[at(i)]));
    for (Index j = 0; j < i; ++j) {
      const double least =
          j < p.on_surface ? 0.5 * p.diameter[at(i)] + 0.55 * mix.smallest
                           : 0.5 * (p.diameter[at(i)] + p.diameter[at(j)]) + 0.01 * mix.smallest;
      EXPECT_GE(norm(p.position[at(i)] - p.position[at(j)]), least * (1.0 - 1e-12));
    }
  }
  for (Index i = 0; i < p.on_surface; ++i) EXPECT_NEAR(cube.depth(p.position[at(i)]), 0.0, 1e-15);
}

TEST(LdpmGeometry, grains_keep_off_bars_which_take_their_volume) {
  const std::vector<Capsule> bars{{{-0.02, 0.0, 0.0}, {0.02, 0.0, 0.0}, 0.008},
                                  {{0.0, -0.02, 0.012}, {0.0, 0.02, 0.012}, 0.004}};
  const LdpmParticles p = place_particles(cube, mix, {1, 0}, bars);
  const auto count = static_cast<Index>(p.position.size());
  double solid = 0.0;
  for (Index i = p.on_surface; i < count; ++i) {
    const double d = p.diameter[at(i)];
    solid += pi / 6.0 * d * d * d;
    for (const Capsule& bar : bars)
      EXPECT_GE(norm(from_axis(bar, p.position[at(i)])), 0.5 * d + bar.radius);
  }
  const double steel = pi * 0.04 * (0.008 * 0.008 + 0.004 * 0.004);
  const double wanted = mix.placed() * (cube.volume() - steel);
  EXPECT_LE(solid, wanted);
  EXPECT_GT(solid, wanted - pi / 6.0 * 12e-3 * 12e-3 * 12e-3);
}

TEST(LdpmGeometry, a_mix_that_does_not_fit_is_refused) {
  MixDesign dense = mix;
  dense.cement = 1.0;
  dense.fuller = 4.0;  // nearly all aggregate is placed
  EXPECT_THROW(place_particles(cube, dense, {1, 0}), InputError);
}

TEST(LdpmGeometry, tetrahedra_and_cells_fill_the_body) {
  for (const Container& body :
       {cube, Container{.shape = Container::Shape::box, .size = {0.04, 0.06, 0.08}}}) {
    const Geometry g(body);
    double volume = 0.0;
    for (const Tetrahedron& t : g.tetrahedra) volume += g.volume_of(t);
    EXPECT_NEAR(volume / body.volume(), 1.0, 1e-12);
    double cells = 0.0, weights = 0.0;
    for (const LdpmCell& cell : cells_of(g.particles.position, g.facets)) cells += cell.volume;
    for (const LdpmFacet& f : g.facets)
      weights += f.area * norm(g.particles.position[at(f.b)] - g.particles.position[at(f.a)]);
    EXPECT_NEAR(cells / body.volume(), 1.0, 1e-12);
    EXPECT_NEAR(weights / (3.0 * body.volume()), 1.0, 1e-12);
  }
}

/// About the axis of a body: of its cells, mass by mass, and of particles that have the mass of
/// their cell at their centre and the mean of its three moments of inertia. Cells of the surface
/// have their mass further in.
TEST(LdpmGeometry, cells_turn_as_the_body_does_and_particles_somewhat_heavier) {
  const double side = 0.04;
  const Geometry g({.shape = Container::Shape::box, .size = {side, side, 0.08}});
  const auto& x = g.particles.position;
  double exact = 0.0, lumped = 0.0;
  for (const LdpmFacet& f : g.facets)
    for (const Index tip : {f.a, f.b}) {
      const Vec3 p[4] = {x[at(tip)], f.corners[0], f.corners[1], f.corners[2]};
      Vec3 sum{};
      double squares = 0.0;
      for (const Vec3& q : p) sum = sum + q, squares += q.x * q.x + q.y * q.y;
      exact += std::abs(six_volumes(p[0], p[1], p[2], p[3])) / 120.0 *
               (squares + sum.x * sum.x + sum.y * sum.y);
    }
  const auto cells = cells_of(x, g.facets);
  for (std::size_t i = 0; i < cells.size(); ++i)
    lumped += cells[i].inertia + cells[i].volume * (x[i].x * x[i].x + x[i].y * x[i].y);
  const double body = side * side * 0.08 * side * side / 6.0;
  EXPECT_NEAR(exact / body, 1.0, 1e-12);
  EXPECT_GT(lumped / body, 1.0);
  EXPECT_LT(lumped / body, 1.15);
}

TEST(LdpmGeometry, a_cylinder_is_filled_up_to_the_chords_of_its_surface) {
  const Container body{.shape = Container::Shape::cylinder, .radius = 0.03, .length = 0.06};
  const Geometry g(body);
  double volume = 0.0;
  for (const Tetrahedron& t : g.tetrahedra) volume += g.volume_of(t);
  EXPECT_LT(volume, body.volume());
  EXPECT_GT(volume, 0.95 * body.volume());
  for (Index i = 0; i < g.particles.on_surface; ++i)
    EXPECT_NEAR(body.depth(g.particles.position[at(i)]), 0.0, 1e-14);
}

TEST(LdpmGeometry, areas_times_lengths_are_three_volumes_in_each_tetrahedron) {
  const Geometry g(cube);
  int folded = 0;
  for (const Tetrahedron& t : g.tetrahedra) {
    double sum = 0.0;
    const auto facets = facets_of(g.particles.position, g.diameter, {t});
    ASSERT_EQ(facets.size(), 12U);
    for (const LdpmFacet& f : facets)
      sum += f.area * norm(g.particles.position[at(f.b)] - g.particles.position[at(f.a)]);
    const double error = std::abs(sum / (3.0 * g.volume_of(t)) - 1.0);
    if (error > 1e-9) ++folded;
  }
  EXPECT_EQ(folded, 0);
}

TEST(LdpmGeometry, the_same_seed_gives_the_same_bits_and_another_seed_another_body) {
  const Geometry one(cube), same(cube), other(cube, 2);
  ASSERT_EQ(one.facets.size(), same.facets.size());
  for (std::size_t k = 0; k < one.facets.size(); ++k) {
    EXPECT_EQ(one.facets[k].area, same.facets[k].area);
    EXPECT_EQ(one.facets[k].center.x, same.facets[k].center.x);
  }
  EXPECT_NE(one.particles.position.back().x, other.particles.position.back().x);
}

// Edge 1, radii 0: the facets of the public single tetrahedron.
TEST(LdpmGeometry, a_regular_tetrahedron_has_twelve_equal_facets) {
  const std::vector<Vec3> x{{0.0, 0.0, 0.0},
                            {1.0, 0.0, 0.0},
                            {0.5, 0.8660254037844386, 0.0},
                            {0.5, 0.2886751345948129, 0.816496580927726}};
  const auto tetrahedra = tetrahedra_of(x, 1.0);
  ASSERT_EQ(tetrahedra.size(), 1U);
  const auto facets = facets_of(x, std::vector<double>(4, 0.0), tetrahedra);
  for (const LdpmFacet& f : facets) EXPECT_NEAR(f.area, 0.0294627825, 1e-10);
  EXPECT_NEAR(facets[0].center.x, 0.5, 1e-10);
  EXPECT_NEAR(facets[0].center.y, 0.1283000598, 1e-10);
  EXPECT_NEAR(facets[0].center.z, 0.1587632241, 1e-10);
  const auto cells = cells_of(x, facets);
  const double mean = (4.746782e-12 + 9.679070e-12 + 1.091214e-11) / 3.0 / 2.4e-9;
  for (const LdpmCell& cell : cells) {
    EXPECT_NEAR(cell.volume, 7.071068e-11 / 2.4e-9, 1e-8);
    EXPECT_NEAR(cell.inertia, mean, 1e-6 * mean);
  }
}

}  // namespace ldpm_test
}  // namespace breccia::prepare
