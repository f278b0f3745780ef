// LDPM in a world: forces of the public tetrahedron, affine and rigid motions, energies.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dem/energy.hpp"
#include "dem/observe.hpp"
#include "dem/setup/materials.hpp"
#include "prepare/build.hpp"
#include "prepare/ldpm/body.hpp"
#include "run/method/dem_method.hpp"
#include "scene.hpp"

namespace breccia::dem {
namespace ldpm_test {

using testing::Scene;
using testing::state;

/// One regular tetrahedron, edge 1, E_0 = 30000, alpha = 0.2; units N, mm, t, s.
/// @param stiffer  E_0 is so many times that
Scene tetrahedron(double stiffer = 1.0) {
  Scene s;
  const double poisson = 0.8 / 4.2;
  MaterialConfig& concrete =
      s.material("concrete", "ldpm", stiffer * 30000.0 * (1.0 - 2.0 * poisson), poisson, 2.4e-9);
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

/// Eigenvalues of a symmetric matrix, ascending, by Jacobi's rotations.
std::vector<double> eigenvalues(std::vector<std::vector<double>> m) {
  const std::size_t n = m.size();
  for (int sweep = 0; sweep < 30; ++sweep)
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = p + 1; q < n; ++q) {
        if (m[p][q] == 0.0) continue;
        const double angle = 0.5 * std::atan2(2.0 * m[p][q], m[q][q] - m[p][p]);
        const double c = std::cos(angle), s = std::sin(angle);
        for (std::size_t k = 0; k < n; ++k) {
          const double kp = m[k][p], kq = m[k][q];
          m[k][p] = c * kp - s * kq, m[k][q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < n; ++k) {
          const double pk = m[p][k], qk = m[q][k];
          m[p][k] = c * pk - s * qk, m[q][k] = s * pk + c * qk;
        }
      }
  std::vector<double> values;
  for (std::size_t k = 0; k < n; ++k) values.push_back(m[k][k]);
  std::sort(values.begin(), values.end());
  return values;
}
/// Stiffness of the tetrahedron against displacements and turns of its corners.
std::vector<std::vector<double>> stiffness_of_tetrahedron() {
  const double tiny = 1e-8, dt = 1e-9;
  std::vector<std::vector<double>> k(24, std::vector<double>(24));
  for (int column = 0; column < 24; ++column) {
    World w = tetrahedron().world();
    for (ElementState& s : w.elements.state.host()) s.velocity = s.spin = {};
    ElementState& s = w.elements.state.data()[column / 6];
    double moved[6] = {};
    moved[column % 6] = tiny;
    s.position += Vec3{moved[0], moved[1], moved[2]};
    s.velocity = (1.0 / dt) * Vec3{moved[0], moved[1], moved[2]};
    s.spin = (1.0 / dt) * Vec3{moved[3], moved[4], moved[5]};
    w.last_dt = dt;
    evaluate_forces(w);
    for (Index e = 0; e < 4; ++e) {
      const Vec3 f = w.elements.force.data()[e], t = w.elements.torque.data()[e];
      const std::array<double, 6> found{f.x, f.y, f.z, t.x, t.y, t.z};
      for (std::size_t row = 0; row < 6; ++row)
        k[6 * at(e) + row][static_cast<std::size_t>(column)] = -found[row] / tiny;
    }
  }
  return k;
}

TEST(Ldpm, the_tetrahedron_has_the_published_stiffnesses_and_six_free_motions) {
  auto k = stiffness_of_tetrahedron();
  for (std::size_t i = 0; i < 24; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_NEAR(k[i][j], k[j][i], 1e-2) << i << ' ' << j;
      k[i][j] = k[j][i] = 0.5 * (k[i][j] + k[j][i]);
    }
  const std::vector<double> found = eigenvalues(k);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(found[i], 0.0, 2e-3) << i;
  const double published[] = {19.6223, 19.6223, 20.5656, 20.5656, 20.5656, 24.2529,
                              24.2529, 24.2529, 39.2837, 1875.97, 1875.97, 1875.97,
                              3303.13, 3303.13, 4454.09, 4454.09, 4454.09, 7071.07};
  for (std::size_t i = 0; i < 18; ++i)
    EXPECT_NEAR(found[6 + i], published[i], 2e-5 * published[i] + 2e-3) << i;
}

// The bound of turns takes the largest of the three stiffnesses of each facet, and adds those.
TEST(Ldpm, the_step_is_stable_and_over_half_as_long_as_may_be) {
  auto k = stiffness_of_tetrahedron();
  const World w = tetrahedron().world();
  for (std::size_t i = 0; i < 24; ++i)
    for (std::size_t j = 0; j < 24; ++j) {
      const auto of = [&](std::size_t dof) {
        return (dof % 6 < 3 ? w.elements.mass.data() : w.elements.inertia.data())[dof / 6];
      };
      k[i][j] /= std::sqrt(of(i) * of(j));
    }
  const double stable = 2.0 / std::sqrt(eigenvalues(k).back());
  const double taken = step_rule(w)(w.critical.data()[0], 0.0) / step_rule(w).safety;
  EXPECT_LT(taken, stable);
  EXPECT_GT(taken, 0.5 * stable);
}

/// The tetrahedron above with the parameters of the public ones.
World public_tetrahedron(double stiffer = 1.0) {
  Scene s = tetrahedron(stiffer);
  LdpmConfig& c = s.config.materials[0].ldpm;
  c.softening_exponent = 0.2;
  c.collapse_strength = 120.0;
  c.hardening = 0.33;
  c.compaction_strain = 3.0;
  c.deviatoric_start = 0.5;
  c.friction_stress = 600.0;
  return s.world();
}

/// A field of the first link in a frame.
double shown(const World& w, const std::string& name) {
  for (const FrameField& field : dem_frame(w).frame.line_fields)
    if (field.name == name) return field.values[0];
  ADD_FAILURE() << name;
  return 0.0;
}

/// Corner 1 out by 0.02, in by 0.2, out again, 1e-4 a step: what an independent program gives.
TEST(Ldpm, a_tetrahedron_opened_and_crushed_follows_the_published_stresses) {
  World w = public_tetrahedron();
  double at_corner = 0.0;
  const auto reach = [&](double a) {
    const int steps = static_cast<int>(std::lround(std::fabs(a - at_corner) / 1e-4));
    for (int k = 1; k <= steps; ++k) {
      const double to = at_corner + (a - at_corner) * k / steps;
      bring(w, [&](const Vec3& x) { return x.x > 0.6 ? Vec3{1.0 + to, 0.0, 0.0} : x; });
    }
    at_corner = a;
    return w.ldpm.state.data()[0].stress.x;  // facets are sorted by their ends: of edge 0-1
  };
  ASSERT_EQ(w.ldpm.a.data()[0] + w.ldpm.b.data()[0], 1);
  EXPECT_NEAR(reach(0.01), 1.354499, 1e-6);
  const LdpmFacetState& of_12 = w.ldpm.state.data()[6];  // of an edge that turns
  EXPECT_NEAR(of_12.stress.x, 2.054748, 0.02);
  EXPECT_NEAR(std::hypot(of_12.stress.y, of_12.stress.z), 0.711785, 0.02);
  EXPECT_NEAR(reach(0.02), 0.606663, 1e-6);
  EXPECT_NEAR(shown(w, "opening"), 0.02 - 0.606663 / 30000.0, 1e-8);
  EXPECT_NEAR(shown(w, "slip"), 0.0, 1e-8);
  const double closed = reach(0.0);  // -3, an increment beyond, if no rounding keeps it open
  EXPECT_GT(closed, -3.0 - 1e-6);
  EXPECT_LT(closed, 1e-6);
  EXPECT_NEAR(reach(-0.09), -237.871033, 1e-5);
  EXPECT_NEAR(reach(-0.2), -602.149170, 1e-5);
  EXPECT_EQ(shown(w, "opening"), 0.0);
  EXPECT_NEAR(reach(-0.09), 0.0, 1e-6);
  EXPECT_NEAR(reach(0.02), 0.606663, 1e-6);
}

/// The law knows strains only times its moduli: a million times as stiff and as little moved, the
/// other edges turn by less than 1e-6, and have the stresses of a program that lets none turn.
TEST(Ldpm, a_tetrahedron_that_hardly_turns_follows_the_published_stresses_on_all_edges) {
  constexpr double scale = 1e-6;
  World w = public_tetrahedron(1.0 / scale);
  double at_corner = 0.0;
  const auto reach = [&](double a) {
    const int steps = static_cast<int>(std::lround(std::fabs(a - at_corner) / 1e-4));
    for (int k = 1; k <= steps; ++k) {
      const double to = 1.0 + scale * (at_corner + (a - at_corner) * k / steps);
      bring(w, [&](const Vec3& x) { return x.x > 0.6 ? Vec3{to, 0.0, 0.0} : x; });
    }
    at_corner = a;
  };
  const auto expect = [&](double normal, double other_normal, double other_tangential) {
    const auto near = [&](double found, double wanted) {
      EXPECT_NEAR(found, wanted, 2e-5 * (1.0 + std::fabs(wanted))) << at_corner;
    };
    for (Index i : {0, 1}) near(w.ldpm.state.data()[i].stress.x, normal);
    for (Index i : {6, 7, 8, 9}) {  // edges 1-2, 1-3
      const Vec3& s = w.ldpm.state.data()[i].stress;
      near(s.x, other_normal);
      near(std::hypot(s.y, s.z), other_tangential);
    }
    for (Index i : {2, 3, 4, 5, 10, 11})  // edges without corner 1
      EXPECT_LT(norm(w.ldpm.state.data()[i].stress), 1e-4);
  };
  reach(0.01), expect(1.354499, 2.054748, 0.711785);
  reach(0.02), expect(0.606663, 1.423558, 0.493135);
  reach(0.0);  // an increment of compression or none, as rounding decides
  reach(-0.09), expect(-237.871033, -487.303756, 140.965807);
  reach(-0.2), expect(-602.149170, -1994.480708, 238.859120);
  reach(-0.09), expect(0.0, -344.480708, 112.333898);
  reach(0.02), expect(0.606663, 0.031908, 0.011053);
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

/// Far beyond pore collapse, where e_V = ((1 + e)^3 - 1) / 3 differs from e by 2 %.
TEST(Ldpm, all_around_crushing_of_a_body_is_that_of_one_facet) {
  const Config config = cube();
  World w = make_world(config, build_model(config, ""), {});
  const LdpmFacet law = ldpm_facet(config.materials[0]);
  LdpmFacetState one{};
  constexpr int steps = 200;
  double last = 0.0;
  for (int k = 1; k <= steps; ++k) {
    const double strain = -0.02 * k / steps;
    bring(w, [&](const Vec3& x) { return ((1.0 + strain) / (1.0 + last)) * x; });
    const double volumetric = ((1.0 + strain) * (1.0 + strain) * (1.0 + strain) - 1.0) / 3.0;
    law.update(0.01, Vec3{strain, 0.0, 0.0}, volumetric, one);
    last = strain;
  }
  EXPECT_LT(one.stress.x, -600e6);
  for (const LdpmFacetState& s : w.ldpm.state.host()) {
    EXPECT_NEAR(s.stress.x, one.stress.x, 1e-8 * std::fabs(one.stress.x));
    EXPECT_LT(std::hypot(s.stress.y, s.stress.z), 1e-6 * std::fabs(one.stress.x));
  }
}

/// u_z = e z alone: each facet has the strain of its direction, and the body E_0 by the mean of
/// n_z^4 + alpha n_z^2 (1 - n_z^2), which is that of a body without texture to some per cent.
TEST(Ldpm, a_body_held_aside_is_as_stiff_as_its_facets_say) {
  const Config config = cube();
  World w = make_world(config, build_model(config, ""), {});
  const LdpmFacet law = ldpm_facet(config.materials[0]);
  const double strain = -1e-5;
  bring(w, [&](const Vec3& x) { return Vec3{x.x, x.y, (1.0 + strain) * x.z}; });
  double virial = 0.0;
  for (Index i = 0; i < w.ldpm.size(); ++i) {
    const Vec3 a = state(w, w.ldpm.a.data()[i]).position, b = state(w, w.ldpm.b.data()[i]).position;
    const double nz = (b.z - a.z) / norm(b - a), square = nz * nz;
    const LdpmFacetState& s = w.ldpm.state.data()[i];
    EXPECT_NEAR(s.strain.x, strain * square, 3e-5 * std::fabs(strain));
    EXPECT_NEAR(std::hypot(s.strain.y, s.strain.z),
                std::fabs(strain * nz) * std::sqrt(std::fabs(1.0 - square)),
                3e-5 * std::fabs(strain));
    const LdpmPlace& p = w.ldpm.place.data()[i];
    virial += p.area * p.length * law.young * strain * square *
              (square + law.shear_ratio * (1.0 - square));
  }
  const double mean = virial / (0.04 * 0.04 * 0.04) / (law.young * strain);
  EXPECT_NEAR(mean, 3.0 * (0.2 + law.shear_ratio * (1.0 / 3.0 - 0.2)), 0.03);
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

/// A prism torn in two hangs on its bar, which yields: sigma_y A_s and what it has hardened.
TEST(Ldpm, a_torn_prism_hangs_on_its_bar) {
  Config config = cube();
  config.materials[0].ldpm.tensile_length = 0.1;
  MaterialConfig steel, bond;
  steel.name = "b500";
  steel.law = "steel";
  steel.density = 7850.0;
  steel.young = 200e9;
  steel.poisson = 0.3;
  steel.yield = 500e6;
  steel.hardening = 1e9;
  bond.name = "bond";
  bond.law = "interface";
  config.materials.push_back(steel);
  config.materials.push_back(bond);
  config.bodies[0].size = {0.03, 0.03, 0.06};
  BodyConfig bar;
  bar.name = "bar";
  bar.shape = "rebar";
  bar.material = "b500";
  bar.rebar.in = "cube";
  bar.rebar.interface_law = "bond";
  bar.rebar.diameter = 4e-3;
  bar.rebar.drawn.emplace_back().points = {{0.0, 0.0, -0.028}, {0.0, 0.0, 0.028}};
  config.bodies.push_back(bar);
  SupportConfig foot, head;
  foot.name = "foot";
  foot.min = {-1.0, -1.0, -1.0};
  foot.max = {1.0, 1.0, -0.02};
  foot.fix = {"all"};
  head = foot;
  head.name = "head";
  head.min.z = 0.02;
  head.max.z = 1.0;
  head.velocity = {0.0, 0.0, 2.0};
  head.ramp = 5e-5;
  config.supports = {foot, head};
  const auto pull_of = [](const Config& of) {
    const Model model = build_model(of, "");
    World w = make_world(of, model, {});
    double pull = 0.0;
    int late = 0;
    while (w.time < 1.5e-4) {
      step(w);
      if (w.time < 1.0e-4) continue;
      ++late;
      pull -= probe(w, {"", "head", "force_z", "sum"});
    }
    EXPECT_LT(std::fabs(balance(w).error_relative), 0.02);
    return pull / late;
  };
  const double section = 3.14159265 * 4e-6;
  const double with_bar = pull_of(config);
  EXPECT_GT(with_bar, 500e6 * section);
  EXPECT_LT(with_bar, 1.2 * 500e6 * section);
  config.bodies.pop_back();
  EXPECT_LT(std::fabs(pull_of(config)), 0.05 * 500e6 * section);
}

}  // namespace ldpm_test
}  // namespace breccia::dem
