// Stiffness of packed members: E that is asked for is got, and members few elements thick bend as
// Timoshenko says.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "dem/observe.hpp"
#include "dem/setup/materials.hpp"
#include "prepare/packing/elastic_network.hpp"
#include "specimen.hpp"

namespace breccia::dem {
namespace stiffness_test {

using prepare::Displacements;
using prepare::ElasticNetwork;
using testing::Specimen;

Specimen block(int count, const Vec3& size, double compactness, int seed, bool corrected) {
  Specimen s(count, size);
  s.config.seed = seed;
  s.config.bodies[0].pack.compactness = compactness;
  s.config.links.range = 1.443;
  s.material().fabric = corrected ? "even" : "packed";
  s.material().stiffness = corrected ? "measured" : "estimated";
  return s;
}

std::vector<Index> all_of(const Model& m) {
  std::vector<Index> all;
  for (Index e = 0; e < m.size(); ++e) all.push_back(e);
  return all;
}

/// Slope of v over x.
double slope(const std::vector<std::array<double, 2>>& points) {
  double x = 0.0, v = 0.0, xx = 0.0, xv = 0.0;
  for (const auto& [p, q] : points) x += p, v += q, xx += p * p, xv += p * q;
  const auto n = static_cast<double>(points.size());
  return (xv - x * v / n) / (xx - x * x / n);
}

/// E of a prism that is pulled step by step: force of the ends over section and strain of the
/// middle half.
double pulled_modulus(const Specimen& specimen) {
  const Model m = specimen.model();
  const double rate = 0.2, half = 0.5 * specimen.size.z;
  Config config = specimen.config;
  const Vec3 far = 10.0 * specimen.size, speed{0.0, 0.0, rate * half};
  const double layer = half - 0.008;
  config.supports = {{"top", "", {-far.x, -far.y, layer}, far, {"z"}, speed, 0.0},
                     {"bottom", "", -1.0 * far, {far.x, far.y, -layer}, {"z"}, -1.0 * speed, 0.0}};
  Model moving = m;
  for (std::size_t e = 0; e < m.position.size(); ++e)
    moving.velocity[e] =
        rate * Vec3{-0.2 * m.position[e].x, -0.2 * m.position[e].y, m.position[e].z};
  World w = make_world(config, moving, {});
  while (w.time * rate < 3e-5) step(w);
  std::vector<std::array<double, 2>> middle;
  for (Index e = 0; e < m.size(); ++e) {
    const double z = m.position[static_cast<std::size_t>(e)].z;
    if (std::fabs(z) < 0.5 * half) middle.push_back({z, w.elements.state.data()[e].position.z - z});
  }
  const double pull =
      0.5 * (probe(w, {"", "bottom", "force_z", "sum"}) - probe(w, {"", "top", "force_z", "sum"}));
  return pull / (specimen.size.x * specimen.size.y * slope(middle));
}

TEST(Stiffness, of_prisms_of_any_compactness_is_what_the_case_asks_for) {
  for (const double compactness : {0.5, 0.56, 0.62}) {
    const double e = pulled_modulus(block(1000, {0.1, 0.1, 0.2}, compactness, 1, true));
    const double packed = pulled_modulus(block(1000, {0.1, 0.1, 0.2}, compactness, 1, false));
    std::printf("compactness %.2f: E %.4g Pa, as packed %.4g Pa\n", compactness, e, packed);
    EXPECT_NEAR(e, 30e9, 0.03 * 30e9) << compactness;
  }
}

/// Deflection between two sections of a cantilever, beyond what the turn of the first one makes,
/// over Timoshenko's with the E, nu and edges of the case.
double bending_compliance(const Specimen& s) {
  const Model m = s.model();
  const ElasticNetwork network(m, s.config, all_of(m));
  const double r = network.mean_radius(), half = 0.5 * s.size.x;
  ElasticNetwork::Held held(m.position.size());
  Displacements load(m.position.size());
  const double total = 1.0;
  double loaded = 0.0, arm = 0.0;
  for (const Vec3& x : m.position)
    if (x.x > half - 1.5 * r) loaded += 1.0, arm += x.x;
  arm /= loaded;
  for (std::size_t e = 0; e < m.position.size(); ++e) {
    if (m.position[e].x < -half + 1.5 * r) held.fixed[e].fill(true);
    if (m.position[e].x > half - 1.5 * r) load[e][2] = total / loaded;
  }
  const Displacements u = network.relaxed(held, load, 1e-8);
  struct Section {
    double x, deflection, turn;
  };
  const auto section = [&](double x) {
    std::vector<std::array<double, 2>> along, over;
    double mean_x = 0.0, mean_u = 0.0;
    for (std::size_t e = 0; e < m.position.size(); ++e) {
      if (std::fabs(m.position[e].x - x) > 2.0 * r) continue;
      over.push_back({m.position[e].z, u[e][0]});
      along.push_back({m.position[e].x, u[e][2]});
      mean_x += m.position[e].x, mean_u += u[e][2];
    }
    const auto n = static_cast<double>(over.size());
    return Section{mean_x / n, mean_u / n, -slope(over)};
  };
  const Section a = section(-0.5 * half), b = section(0.5 * half);
  const double l = b.x - a.x, to_load = arm - a.x;
  const double inertia = s.size.y * std::pow(s.size.z, 3) / 12.0, area = s.size.y * s.size.z;
  const double shear = 30e9 / 2.4;
  // u_z = u_z(a) - turn (x - a) + integral of M (b - x)/EI + Q l/(kappa G A), M = P (to_load - x)
  const double expected = total * (to_load * l * l / 2.0 - l * l * l / 6.0) / (30e9 * inertia) +
                          total * l / (5.0 / 6.0 * shear * area);
  return (b.deflection - a.deflection - a.turn * l) / expected;
}

/// Seeds vary the stiffness by 3 %; the mean of three by 2 %.
TEST(Stiffness, of_a_cantilever_five_or_eight_elements_thick_is_Timoshenkos) {
  struct Member {
    int count;
    Vec3 size;
  };
  for (const Member& member : {Member{470, {0.4, 0.1, 0.1}}, Member{1920, {0.4, 0.1, 0.1}}}) {
    double mean = 0.0, packed = 0.0;
    for (int seed = 1; seed <= 3; ++seed) {
      const double own = bending_compliance(block(member.count, member.size, 0.56, seed, true));
      mean += own / 3.0;
      packed += bending_compliance(block(member.count, member.size, 0.56, seed, false)) / 3.0;
    }
    std::printf("%d elements: stiffness over Timoshenko's %.3f, as packed %.3f\n", member.count,
                1.0 / mean, 1.0 / packed);
    EXPECT_NEAR(1.0 / mean, 1.0, 0.05) << member.count;
    EXPECT_LT(1.0 / packed, 0.92) << member.count;
  }
}

/// Compaction counts from D_0 = K S/K_n, which factors on K_n and S must leave as it is.
TEST(Stiffness, and_section_of_every_link_give_its_length_at_the_start) {
  Specimen specimen = block(400, {0.1, 0.1, 0.2}, 0.56, 1, true);
  BodyConfig other = specimen.config.bodies[0];
  other.name = "other";
  other.center = {0.3, 0.0, 0.0};
  other.pack.compactness = 0.5;
  specimen.config.bodies.push_back(other);
  const Model m = specimen.model();
  const World w = make_world(specimen.config, m, {});
  ASSERT_EQ(w.concrete.groups.size(), 2U) << "each body has its own factor";
  double least = 1.0, most = 1.0;
  for (const auto& group : w.concrete.groups)
    for (Index i = group.begin; i < group.end; ++i) {
      const double first =
          group.law.modulus * w.concrete.area.data()[i] / w.concrete.stiffness.data()[i];
      EXPECT_NEAR(first, w.concrete.length.data()[i], 1e-12 * first);
    }
  for (const Model::Link& link : m.links)
    least = std::min(least, link.share), most = std::max(most, link.share);
  EXPECT_LT(least, 0.9);
  EXPECT_GT(most, 1.5);
}

/// Fabric of each element, over that of those deeper than 3.5 R: of sections, or of strengths.
std::vector<double> fabric_over_deep(const Model& m, double depth_of_skin, bool strengths) {
  std::vector<double> fabric(m.position.size());
  for (const Model::Link& link : m.links) {
    const auto a = static_cast<std::size_t>(link.a), b = static_cast<std::size_t>(link.b);
    const double part = link_section(m, link) * (strengths ? link.strength : 1.0) *
                        norm(m.position[b] - m.position[a]);
    fabric[a] += part / std::pow(m.radius[a], 3), fabric[b] += part / std::pow(m.radius[b], 3);
  }
  double deep = 0.0, count = 0.0;
  for (std::size_t e = 0; e < fabric.size(); ++e) {
    const Vec3& x = m.position[e];
    const double below =
        std::min({0.05 - std::abs(x.x), 0.05 - std::abs(x.y), 0.1 - std::abs(x.z)});
    if (below > depth_of_skin) deep += fabric[e], count += 1.0;
  }
  for (double& f : fabric) f *= count / deep;
  return fabric;
}

/// Outermost elements need no strength across the half of their space that lies beyond their
/// centres: 5/6 of that of the bulk by fabric. Stiffness is that of "even".
TEST(Stiffness, of_fabric_faces_is_that_of_even_and_faces_have_five_sixths_of_the_strength) {
  Specimen specimen = block(2000, {0.1, 0.1, 0.2}, 0.56, 1, true);
  const Model even = specimen.model();
  specimen.material().fabric = "faces";
  const Model faces = specimen.model();
  double radius = 0.0;
  for (const double r : faces.radius) radius += r / static_cast<double>(faces.radius.size());
  ASSERT_EQ(even.links.size(), faces.links.size());
  double least = 1.0;
  for (std::size_t k = 0; k < faces.links.size(); ++k) {
    const Model::Link& link = faces.links[k];
    EXPECT_EQ(link.share, even.links[k].share);
    EXPECT_EQ(even.links[k].strength, 1.0);
    EXPECT_EQ(16.0 * link.strength, std::round(16.0 * link.strength));
    least = std::min(least, link.strength);
  }
  EXPECT_LT(least, 0.8);
  const std::vector<double> section = fabric_over_deep(faces, 3.5 * radius, false);
  const std::vector<double> strength = fabric_over_deep(faces, 3.5 * radius, true);
  double outer = 0.0, outer_section = 0.0, count = 0.0;
  for (std::size_t e = 0; e < strength.size(); ++e) {
    const Vec3& x = faces.position[e];
    if (0.05 - std::abs(x.x) > 1.05 * faces.radius[e]) continue;  // touches the face across x
    if (std::min(0.05 - std::abs(x.y), 0.1 - std::abs(x.z)) < 3.0 * radius) continue;
    outer += strength[e], outer_section += section[e], count += 1.0;
  }
  ASSERT_GT(count, 50.0);
  EXPECT_NEAR(outer / count, 5.0 / 6.0, 0.04);
  EXPECT_NEAR(outer_section / count, 1.0, 0.04);
  const World w = make_world(specimen.config, faces, {});
  for (const auto& group : w.concrete.groups)
    EXPECT_NEAR(group.law.cohesion / group.law.tensile_strength,
                specimen.material().cohesion / specimen.material().tensile_strength, 1e-12);
  EXPECT_GT(w.concrete.groups.size(), 3U);
}

/// One short step from rest moves and turns the elements by what they are given.
TEST(Stiffness, of_the_network_at_rest_gives_the_forces_of_the_links) {
  Specimen specimen = block(300, {0.1, 0.1, 0.15}, 0.56, 1, true);
  specimen.config.local_damping = 0.0;
  specimen.material().tensile_strength = specimen.material().cohesion = 1e15;
  specimen.material().rolling_limit = 1e9;
  Model m = specimen.model();
  const ElasticNetwork network(m, specimen.config, all_of(m));
  for (std::size_t e = 0; e < m.position.size(); ++e) {
    const Vec3 x = m.position[e];
    m.velocity[e] = {std::sin(50.0 * x.y), std::sin(40.0 * x.z + 1.0), std::cos(60.0 * x.x)};
    m.spin[e] = {50.0 * std::cos(30.0 * x.y), 50.0 * std::sin(70.0 * x.x), 50.0 * std::sin(x.z)};
  }
  World w = make_world(specimen.config, m, {});
  step(w);
  Displacements u(m.position.size());
  for (std::size_t e = 0; e < u.size(); ++e) {
    const Vec3 v = w.last_dt * m.velocity[e], turn = w.last_dt * m.spin[e];
    u[e] = {v.x, v.y, v.z, turn.x, turn.y, turn.z};
  }
  const Displacements held = network.forces(u);
  double largest = 0.0, worst = 0.0, largest_torque = 0.0, worst_torque = 0.0;
  for (std::size_t e = 0; e < u.size(); ++e) {
    const Vec3 f = w.elements.force.data()[e], t = w.elements.torque.data()[e];
    const double of_links[6] = {f.x, f.y, f.z, t.x, t.y, t.z};
    for (std::size_t c = 0; c < 6; ++c) {
      double &size = c < 3 ? largest : largest_torque, &error = c < 3 ? worst : worst_torque;
      size = std::max(size, std::fabs(held[e][c]));
      error = std::max(error, std::fabs(held[e][c] + of_links[c]));
    }
  }
  // Displacements of some micrometres turn links 10 mm long by 1e-3.
  EXPECT_LT(worst, 3e-3 * largest);
  EXPECT_LT(worst_torque, 3e-3 * largest_torque);
}

}  // namespace stiffness_test
}  // namespace breccia::dem
