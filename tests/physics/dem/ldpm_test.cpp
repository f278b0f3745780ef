// LDPM in a world: forces of the public tetrahedron, affine and rigid motions, energies.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "dem/energy.hpp"
#include "prepare/build.hpp"
#include "prepare/ldpm/body.hpp"
#include "scene.hpp"

namespace breccia::dem {
namespace {

using testing::Scene;
using testing::state;

/// One regular tetrahedron, edge 1, E_0 = 30000, alpha = 0.2; units N, mm, t, s.
Scene tetrahedron() {
  Scene s;
  const double poisson = 0.8 / 4.2;
  MaterialConfig& concrete =
      s.material("concrete", "ldpm", 30000.0 * (1.0 - 2.0 * poisson), poisson, 2.4e-9);
  concrete.tensile_strength = 3.0;
  concrete.cohesion = 7.5;
  concrete.ldpm.tensile_length = 250.0;
  const std::vector<Vec3> x{{0.0, 0.0, 0.0},
                            {1.0, 0.0, 0.0},
                            {0.5, 0.8660254037844386, 0.0},
                            {0.5, 0.2886751345948129, 0.816496580927726}};
  const auto facets =
      prepare::facets_of(x, std::vector<double>(4, 0.0), prepare::tetrahedra_of(x, 1.0));
  for (const Vec3& at : x) s.element(at, 0.4, 7.071068e-11, 8.446e-12);
  for (const auto& f : facets) s.model.facets.push_back({f.a, f.b, f.c, f.d, f.center, f.area});
  prepare::link_facets(s.model);
  return s;
}

/// Brings elements to places and turns, as if in one step, and evaluates the forces there.
template <class Place>
void bring(World& w, const Place& place, const Vec3& turned = {}) {
  const double dt = 1e-9;
  for (Index e = 0; e < w.elements.size(); ++e) {
    ElementState& s = w.elements.state.data()[e];
    const Vec3 to = place(s.position);
    s.velocity = (1.0 / dt) * (to - s.position);
    s.spin = (1.0 / dt) * turned;
    s.position = to;
  }
  w.last_dt = dt;
  evaluate_forces(w);
}

TEST(Ldpm, a_displaced_corner_of_the_public_tetrahedron_needs_the_published_forces) {
  World w = tetrahedron().world();
  ASSERT_EQ(w.ldpm.size(), 12);
  bring(w, [](const Vec3& x) { return x.x > 0.9 ? x + Vec3{1e-5, 0.0, 0.0} : x; });
  const std::array<std::array<double, 6>, 4> holding{
      {{-0.01767767, 0.0, 0.0, 0.0, -0.002004688, 0.002835058},
       {0.03181981, -0.008164966, -0.005773503, 0.0, 0.002646189, -0.003742276},
       {-0.007071068, 0.006123724, 0.0, -6.944444e-4, -8.018754e-4, -0.002948460},
       {-0.007071068, 0.002041241, 0.005773503, 6.944444e-4, 0.003047126, -2.268046e-4}}};
  for (Index e = 0; e < 4; ++e) {
    const Vec3 f = w.elements.force.data()[e], t = w.elements.torque.data()[e];
    const std::array<double, 6> found{-f.x, -f.y, -f.z, -t.x, -t.y, -t.z};
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_NEAR(found[k], holding[at(e)][k], 1e-6) << e << ' ' << k;
  }
}

Config cube() {
  Config config;
  MaterialConfig concrete;
  concrete.name = "concrete";
  concrete.law = "ldpm";
  concrete.density = 2338.0;
  concrete.young = 39e9;
  concrete.poisson = 0.17647;
  concrete.tensile_strength = 3.44e6;
  concrete.cohesion = 8.944e6;
  config.materials = {concrete};
  BodyConfig body;
  body.name = "cube";
  body.shape = "box";
  body.material = "concrete";
  body.size = {0.04, 0.04, 0.04};
  config.bodies = {body};
  config.time.end = 1.0;
  return config;
}

TEST(Ldpm, all_around_compression_strains_every_facet_alike) {
  const Config config = cube();
  const Model model = build_model(config, "");
  World w = make_world(config, model, {});
  double mass = 0.0;
  for (const double m : w.elements.mass.host()) mass += m;
  EXPECT_NEAR(mass / (2338.0 * 0.04 * 0.04 * 0.04), 1.0, 1e-12);
  const double strain = -1e-4;
  bring(w, [&](const Vec3& x) { return (1.0 + strain) * x; });
  const double normal = config.materials[0].young / (1.0 - 2.0 * config.materials[0].poisson);
  double virial = 0.0;
  for (Index i = 0; i < w.ldpm.size(); ++i) {
    const LdpmFacetState& s = w.ldpm.state.data()[i];
    EXPECT_NEAR(s.strain.x, strain, 1e-12);
    EXPECT_NEAR(std::hypot(s.strain.y, s.strain.z), 0.0, 1e-12);
    virial += w.ldpm.place.data()[i].area * w.ldpm.place.data()[i].length * s.stress.x;
  }
  EXPECT_NEAR(virial / (3.0 * 0.04 * 0.04 * 0.04), normal * strain, 1e-8 * normal * 1e-4);
}

TEST(Ldpm, a_rigid_turn_strains_nothing) {
  const Config config = cube();
  const Model model = build_model(config, "");
  World w = make_world(config, model, {});
  const double angle = 0.01;
  const Vec3 axis{2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0};
  for (int k = 0; k < 100; ++k)
    bring(
        w,
        [&](const Vec3& x) {
          return std::cos(angle) * x + std::sin(angle) * cross(axis, x) +
                 ((1.0 - std::cos(angle)) * dot(axis, x)) * axis;
        },
        2.0 * std::tan(0.5 * angle) * axis);
  for (const LdpmFacetState& s : w.ldpm.state.host()) EXPECT_LT(norm(s.strain), 1e-11);
}

TEST(Ldpm, a_released_cube_swings_and_loses_no_energy) {
  Config config = cube();
  config.materials[0].tensile_strength = 1e12;  // elastic
  config.materials[0].cohesion = 1e12;
  config.materials[0].ldpm.collapse_strength = 1e12;
  config.materials[0].ldpm.tensile_length = 100.0;
  const Model model = build_model(config, "");
  World w = make_world(config, model, {});
  bring(w, [](const Vec3& x) { return Vec3{x.x * (1.0 + 1e-4), x.y, x.z * (1.0 - 5e-5)}; });
  for (ElementState& s : w.elements.state.host()) s.velocity = s.spin = Vec3{};
  w.ledger = {};
  w.last_dt = 0.0;
  evaluate_forces(w);
  step(w);  // from here on steps are equal
  const EnergyBalance start = balance(w);
  w.ledger.start = start.kinetic + start.elastic;
  for (int k = 0; k < 300; ++k) step(w);
  const EnergyBalance e = balance(w);
  EXPECT_GT(e.kinetic, 0.1 * w.ledger.start);
  EXPECT_LT(std::fabs(e.missing()), 1e-5 * e.start);
}

}  // namespace
}  // namespace breccia::dem
