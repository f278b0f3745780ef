// Probes of regions: stress, strain, torque, displacement, angular momentum, broken links against
// closed answers.

#include <gtest/gtest.h>

#include <cmath>

#include "core/probe.hpp"
#include "dem/stress.hpp"
#include "physics/dem/scene.hpp"

namespace breccia::dem {
namespace dem_measures_test {

using testing::Scene;

double value(const World& w, const std::string& quantity, const std::string& on = "",
             const char* reduce = "mean", const std::vector<double>& min = {},
             const std::vector<double>& max = {}, const std::vector<double>& about = {}) {
  return probe(w, {"p", on, quantity, reduce, min, max, about});
}

/// Grains of a cubic lattice between six walls, which press on them.
Scene pressed_box(int side) {
  Scene s;
  s.material("grain", "grain", 1e8, 0.2, 2500.0);
  s.config.local_damping = 0.5;
  s.config.contact.friction = 0.0;  // otherwise side walls bear a part
  const double pitch = 0.01998, edge = pitch * side;
  for (int i = 0; i < side * side * side; ++i)
    s.sphere({pitch * (i % side + 0.5), pitch * (i / side % side + 0.5),
              pitch * (i / side / side + 0.5)},
             0.01);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      Vec3 normal{}, point{};
      (axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z) = sign;
      if (sign < 0.0) point = {edge, edge, edge};
      s.wall(point, normal);
      s.config.walls.back().name = std::string(sign > 0.0 ? "low " : "high ") + "xyz"[axis];
    }
  return s;
}

TEST(Measures, stress_of_a_box_between_pressing_walls_is_their_pressure) {
  const int side = 3;
  Scene s = pressed_box(side);
  s.config.walls[5].point.z -= 2e-5;  // the pressure along z is another one
  World w = s.world();
  for (int i = 0; i < 20'000; ++i) step(w);
  const double edge = 0.01998 * side;
  const std::vector<double> low{0.0, 0.0, 0.0}, high{edge, edge, edge - 2e-5};
  for (const char* axis : {"x", "y", "z"}) {
    const double area = axis[0] == 'z' ? edge * edge : edge * (edge - 2e-5);
    const double pressure =
        value(w, std::string("force_") + axis, std::string("high ") + axis, "sum") / area;
    EXPECT_GT(pressure, 0.0);
    EXPECT_NEAR(value(w, std::string("stress_") + axis + axis, "", "mean", low, high), -pressure,
                1e-9 * pressure);
    // So has any box through which the whole section runs.
    if (axis[0] != 'z') continue;
    EXPECT_NEAR(value(w, "stress_zz", "", "mean", {0.0, 0.0, 0.013}, {edge, edge, 0.0371}),
                -pressure, 1e-9 * pressure);
  }
  const double shear = value(w, "stress_xz", "", "mean", low, high);
  EXPECT_NEAR(shear, 0.0, 1e-9 * std::abs(value(w, "stress_zz", "", "mean", low, high)));
}

/// A prism of linked elements, irregular, held below and pulled above.
Scene prism() {
  Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0);
  s.config.local_damping = 0.5;
  const int side = 3, height = 7;
  const auto shaken = [](int i, int k) { return 5e-4 * std::sin(7.0 * i + 3.0 * k); };
  for (int i = 0; i < side * side * height; ++i)
    s.sphere({0.021 * (i % side) + shaken(i, 0), 0.021 * (i / side % side) + shaken(i, 1),
              0.021 * (i / side / side) + shaken(i, 2)},
             0.01);
  for (Index a = 0; a < s.model.size(); ++a)
    for (Index b = a + 1; b < s.model.size(); ++b)
      if (norm(s.model.position[at(b)] - s.model.position[at(a)]) < 0.031) s.link(a, b);
  SupportConfig foot, head;
  foot.name = "foot";
  foot.max.z = 0.005;
  foot.fix = {"all"};
  head.name = "head";
  head.min.z = 0.12;
  head.fix = {"z"};
  OverTime<Vec3> pull;
  pull.times = {0.0, 1e-4, 2e-4};
  pull.values = {{}, {0.0, 0.0, 0.02}, {}};
  head.velocity = pull;
  s.config.supports = {foot, head};
  return s;
}

TEST(Measures, stress_of_a_pulled_prism_is_force_over_section) {
  const Scene s = prism();
  World w = s.world();
  for (int i = 0; i < 20'000; ++i) step(w);
  const double force = -value(w, "force_z", "head", "sum"), section = 0.1 * 0.1;
  EXPECT_GT(force, 10.0);
  EXPECT_NEAR(value(w, "stress_zz", "", "mean", {-0.02, -0.02, 0.03}, {0.08, 0.08, 0.1}),
              force / section, 1e-6 * force / section);
  EXPECT_NEAR(value(w, "stress_zz", "", "mean", {-0.02, -0.02, 0.0512}, {0.08, 0.08, 0.0613}),
              force / section, 1e-6 * force / section);
  EXPECT_NEAR(value(w, "stress_xx", "", "mean", {-0.02, -0.02, 0.03}, {0.08, 0.08, 0.1}), 0.0,
              0.1 * force / section);
  EXPECT_NEAR(value(w, "torque_x", "head", "sum") + value(w, "torque_x", "foot", "sum"), 0.0,
              1e-6 * force * 0.02);
}

/// Sum of stress times volume over all elements.  [N m]
Stress moments_of(const World& w, double density) {
  const std::vector<Stress> all = stresses(w);
  Stress sum{};
  for (Index e = 0; e < w.elements.size(); ++e)
    for (std::size_t k = 0; k < sum.size(); ++k)
      sum[k] += all[at(e)][k] * w.elements.mass.data()[e] / density;
  return sum;
}

TEST(Measures, stresses_of_elements_have_the_mean_of_a_box_around_them) {
  const Scene pulled = prism(), pressed = pressed_box(3);
  for (const Scene* s : {&pulled, &pressed}) {
    World w = s->world();
    for (int i = 0; i < 5000; ++i) step(w);
    const Stress sum = moments_of(w, s->config.materials[0].density);
    const std::vector<double> low{-0.02, -0.02, -0.02}, high{0.1, 0.1, 0.2};
    const double volume = 0.12 * 0.12 * 0.22;
    const char* const names[] = {"stress_xx", "stress_yy", "stress_zz",
                                 "stress_xy", "stress_yz", "stress_xz"};
    const double scale = std::fabs(sum[2]);
    EXPECT_GT(scale, 0.0);
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_NEAR(sum[k], volume * value(w, names[k], "", "mean", low, high), 1e-9 * scale)
          << names[k];
  }
}

TEST(Measures, strain_and_displacement_of_a_uniform_flow_are_exact) {
  Scene s;
  s.material("grain", "grain", 1e8, 0.2, 2500.0);
  const double g[3][3] = {{2.0, 1.0, 0.0}, {3.0, -1.0, 0.5}, {0.0, 0.25, 4.0}};
  for (int i = 0; i < 27; ++i) {
    const Vec3 x{0.1 * (i % 3), 0.1 * (i / 3 % 3) + 0.01 * (i % 2), 0.1 * (i / 9)};
    s.sphere(x, 0.01,
             {g[0][0] * x.x + g[0][1] * x.y + g[0][2] * x.z,
              g[1][0] * x.x + g[1][1] * x.y + g[1][2] * x.z,
              g[2][0] * x.x + g[2][1] * x.y + g[2][2] * x.z});
  }
  s.wall({0.0, 0.0, -1.0}, {0.0, 0.0, 1.0}, {0.0, 0.0, -0.5});
  const char* axes = "xyz";
  const std::vector<double> min{-1.0, -1.0, 0.05}, max{1.0, 1.0, 1.0};
  for (const char* word :
       {"strain_xx", "strain_yy", "strain_zz", "strain_xy", "strain_yz", "strain_xz"}) {
    s.config.probes.push_back({word, "", word, "mean"});
    s.config.probes.push_back({std::string(word) + " above", "", word, "mean", min, max});
  }
  World w = s.world();
  while (w.time < 1e-3) step(w);
  for (const ProbeConfig& p : s.config.probes) {
    const std::size_t i = std::string(axes).find(p.quantity[7]),
                      j = std::string(axes).find(p.quantity[8]);
    EXPECT_NEAR(probe(w, p), 0.5 * w.time * (g[i][j] + g[j][i]), 1e-12) << p.name;
  }
  EXPECT_NEAR(value(w, "displacement_z", "", "max"), w.time * 0.25 * 0.21 + w.time * 4.0 * 0.2,
              1e-12);
  EXPECT_NEAR(value(w, "displacement_z", "wall"), -0.5 * w.time, 1e-12);
}

TEST(Measures, a_spinning_body_keeps_its_angular_momentum) {
  Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0);
  const Vec3 spin{3.0, -5.0, 20.0}, along{1.0, 2.0, -3.0};
  double mass = 0.0;
  Vec3 expected{}, centre{};
  for (int i = 0; i < 8; ++i) {
    const Vec3 x{0.02 * (i & 1), 0.02 * (i >> 1 & 1), 0.02 * (i >> 2)};
    s.sphere(x, 0.01, along + cross(spin, x), spin);
    const double m = s.model.mass.back();
    mass += m;
    centre += m * x;
    expected += m * cross(x, along + cross(spin, x)) + s.model.inertia.back() * spin;
  }
  for (Index a = 0; a < 8; ++a)
    for (Index b = a + 1; b < 8; ++b) s.link(a, b);
  World w = s.world();
  const auto angular = [&](const std::vector<double>& about) {
    return Vec3{value(w, "angular_momentum_x", "", "sum", {}, {}, about),
                value(w, "angular_momentum_y", "", "sum", {}, {}, about),
                value(w, "angular_momentum_z", "", "sum", {}, {}, about)};
  };
  EXPECT_LT(norm(angular({}) - expected), 1e-14 * norm(expected));
  for (int i = 0; i < 500; ++i) step(w);
  EXPECT_LT(norm(angular({}) - expected), 1e-11 * norm(expected));
  const Vec3 point{1.0, -2.0, 0.5};
  EXPECT_LT(norm(angular({1.0, -2.0, 0.5}) -
                 (expected - mass * cross(point, along + cross(spin, (1.0 / mass) * centre)))),
            1e-11 * norm(expected) + 1e-11 * mass * norm(point) * norm(along));
}

TEST(Measures, torque_of_a_wall_is_its_force_times_the_arm) {
  Scene s;
  s.material("grain", "grain", 1e7, 0.2, 2500.0);
  s.config.gravity = {0.0, 0.0, -9.81};
  s.config.local_damping = 0.3;
  s.sphere({0.3, 0.1, 0.01}, 0.01);
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  World w = s.world();
  for (int i = 0; i < 20'000; ++i) step(w);
  const double weight = 9.81 * s.model.mass[0];
  EXPECT_NEAR(value(w, "torque_y", "wall", "sum"), 0.3 * weight, 1e-6 * weight);
  EXPECT_NEAR(value(w, "torque_x", "wall", "sum"), -0.1 * weight, 1e-6 * weight);
  EXPECT_NEAR(value(w, "torque_y", "wall", "sum", {}, {}, {0.3, 0.0, 0.0}), 0.0, 1e-6 * weight);
}

TEST(Measures, broken_links_are_counted_where_they_are) {
  Scene s = prism();
  OverTime<Vec3> tear;
  tear.value = {0.0, 0.0, 2.0};
  s.config.supports[1].velocity = tear;
  World w = s.world();
  for (int i = 0; i < 600; ++i) step(w);
  const double broken = count(w).broken[static_cast<std::size_t>(LinkKind::concrete)];
  EXPECT_GT(broken, 3.0);
  EXPECT_EQ(value(w, "broken", "", "sum"), broken);
  EXPECT_NEAR(value(w, "broken"), broken / w.concrete.size(), 1e-15);
  const double below = value(w, "broken", "", "sum", {-1.0, -1.0, -1.0}, {1.0, 1.0, 0.0451234});
  const double above = value(w, "broken", "", "sum", {-1.0, -1.0, 0.0451234}, {1.0, 1.0, 1.0});
  EXPECT_EQ(below + above, broken);
  EXPECT_LE(value(w, "broken", "head", "sum"), broken);
}

/// A link that is pulled apart and let close: open by what its force does not explain.
TEST(Measures, opening_of_a_link_is_its_stretch_beyond_its_force) {
  Scene s;
  MaterialConfig& m = s.material("c", "concrete", 30e9, 0.2, 2400.0);
  m.tensile_strength = 3e6;
  m.cohesion = 30e6;
  m.softening = 20.0;
  s.sphere({}, 0.01);
  s.sphere({0.0, 0.0, 0.02}, 0.01);
  s.link(0, 1);
  for (const bool high : {false, true}) {
    SupportConfig held;
    held.name = high ? "high" : "low";
    (high ? held.min : held.max).z = 0.01;
    held.fix = {"all"};
    s.config.supports.push_back(held);
  }
  OverTime<Vec3>& pull = s.config.supports[1].velocity;
  pull.times = {0.0, 2e-4, 2.001e-4, 3e-4, 3.001e-4};
  pull.values = {
      {0.0, 0.0, 0.1}, {0.0, 0.0, 0.1}, {0.0, 0.0, -0.05}, {0.0, 0.0, -0.05}, {0.0, 0.0, 0.4}};
  s.config.time.safety = 0.1;
  World w = s.world();
  const double stiffness = w.concrete.stiffness.data()[0];
  double widest = 0.0, softened = 0.0, misread = 0.0;
  while (w.time < 2e-3) {
    step(w);
    const double stretch = testing::state(w, 1).position.z - testing::state(w, 0).position.z - 0.02;
    const double pulls = -w.elements.force.data()[1].z;
    const double open = value(w, "opening");
    const bool broken = value(w, "broken") > 0.0;
    EXPECT_NEAR(open, std::max(0.0, stretch - pulls / stiffness), 1e-9 * 0.02) << w.time;
    if (broken)
      misread = std::max(misread, std::abs(open - stretch));
    else
      softened = std::max(softened, open);
    widest = std::max(widest, open);
  }
  EXPECT_GT(softened, 1e-6);
  EXPECT_LT(misread, 1e-15);
  EXPECT_GT(widest, 1e-4);
  EXPECT_EQ(value(w, "opening", "", "max", {-1.0, -1.0, 0.5}, {1.0, 1.0, 1.0}), 0.0);
}

TEST(Measures, what_an_object_does_not_have_is_refused) {
  const auto told = [](const ProbeConfig& p, Bearer of) {
    const std::vector<std::string> problems = probe_problems(p, of);
    return problems.empty() ? std::string() : problems.front();
  };
  EXPECT_EQ(told({"p", "", "stress_zz", "mean", {0, 0, 0}, {1, 1, 1}, {}}, in_space), "");
  EXPECT_NE(told({"p", "", "stress_zz", "mean"}, in_space).find("give min and max"),
            std::string::npos);
  EXPECT_NE(told({"p", "", "slip", "mean"}, in_space).find("none of spheres; allowed: position"),
            std::string::npos);
  EXPECT_EQ(told({"p", "w", "kinetic", "sum"}, of_wall), "");
  EXPECT_NE(told({"p", "w", "broken", "mean"}, of_wall).find("none of a wall"), std::string::npos);
  EXPECT_NE(told({"p", "w", "force_x", "max"}, of_wall).find("one value"), std::string::npos);
  EXPECT_NE(told({"p", "", "torque_x", "sum"}, in_plane).find("a plane case lacks"),
            std::string::npos);
  EXPECT_EQ(told({"p", "", "torque_z", "sum", {}, {}, {0, 0}}, in_plane), "");
  EXPECT_NE(told({"p", "", "torque_z", "sum", {}, {}, {0, 0, 0}}, in_plane).find("2 coordinates"),
            std::string::npos);
  EXPECT_NE(told({"p", "", "speed", "mean", {}, {}, {0, 0, 0}}, in_space).find("has none"),
            std::string::npos);
  EXPECT_EQ(told({"p", "", "speed", "mean", {0, 0, 0}, {}, {}}, in_space), "");
  EXPECT_NE(told({"p", "", "speed", "mean", {0, 0, 2}, {1, 1, 1}, {}}, in_space).find("below"),
            std::string::npos);
  EXPECT_NE(told({"p", "", "stress_xx", "sum"}, in_plane).find("do not add up"), std::string::npos);
  EXPECT_NE(told({"p", "", "strain_xx", "max"}, in_plane).find("one value"), std::string::npos);
}

TEST(Measures, each_piece_of_a_hanging_bar_is_pulled_by_the_weight_below_it) {
  constexpr int pieces = 5;
  constexpr double spacing = 0.02, radius = 0.004, gravity = 9.81;
  constexpr double mass = 7850.0 * pi * radius * radius * spacing;
  Scene s;
  s.material("b", "steel", 200e9, 0.3, 7850.0).yield = 1e15;
  s.config.time.safety = 0.5;
  s.config.local_damping = 0.3;
  s.config.gravity = {gravity, 0.0, 0.0};
  for (int i = 0; i <= pieces; ++i) {
    const double own = i == pieces ? 0.5 * mass : mass;
    s.element({i * spacing, 0.0, 0.0}, radius, own,
              own * (spacing * spacing / 12.0 + radius * radius / 4.0));
    if (i > 0) s.link(i - 1, i, LinkKind::steel);
  }
  s.config.supports.push_back(
      {"clamp", "", {-1e-3, -1.0, -1.0}, {1e-3, 1.0, 1.0}, {"all"}, {}, 0.0});
  World w = s.world();
  for (int i = 0; i < 20'000; ++i) step(w);
  const double each = mass * gravity;
  EXPECT_NEAR(value(w, "axial_force", "", "max") / each, 4.5, 1e-4);
  EXPECT_NEAR(value(w, "axial_force", "", "min") / each, 0.5, 1e-4);
  EXPECT_NEAR(value(w, "axial_force") / each, 2.5, 1e-4);
  const double third = 2.5 * spacing;  // the middle of the third piece
  EXPECT_NEAR(
      value(w, "axial_force", "", "mean", {third - 1e-3, -1.0, -1.0}, {third + 1e-3, 1.0, 1.0}) /
          each,
      2.5, 1e-4);
}

}  // namespace dem_measures_test
}  // namespace breccia::dem
