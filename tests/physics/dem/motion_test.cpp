// Motion of single elements, pairs, chains and clouds against closed answers.

#include <gtest/gtest.h>

#include <random>

#include "exec/error.hpp"
#include "scene.hpp"

namespace breccia::dem {
namespace motion_test {

using testing::momentum;
using testing::run_until;
using testing::Scene;
using testing::state;
using testing::velocity_now;

TEST(Motion, free_flight_is_exact) {
  Scene s;
  s.material("g", "grain", 1e9, 0.2, 2500.0);
  s.config.gravity = {0.0, 0.0, -9.81};
  s.config.time.max_step = 1e-3;
  s.sphere({1.0, 2.0, 3.0}, 0.01, {1.0, -2.0, 5.0});
  World w = s.world();
  for (int i = 0; i < 1000; ++i) step(w);
  const double t = w.time;
  EXPECT_NEAR(state(w, 0).position.x, 1.0 + t, 1e-12);
  EXPECT_NEAR(state(w, 0).position.z, 3.0 + 5.0 * t - 0.5 * 9.81 * t * t, 1e-11);
  EXPECT_LT(balance(w).error_relative, 1e-8);  // the first half step, of order dt^2
  // Probes read velocities at the time of the positions, not half a step before.
  const double mass = w.elements.mass.data()[0], vz = 5.0 - 9.81 * t;
  EXPECT_NEAR(probe(w, {"", "", "velocity_z", "mean"}), vz, 1e-11);
  EXPECT_NEAR(probe(w, {"", "", "momentum_z", "sum"}), mass * vz, 1e-11 * mass);
  EXPECT_NEAR(probe(w, {"", "", "speed", "max"}), std::sqrt(5.0 + vz * vz), 1e-11);
  EXPECT_NEAR(probe(w, {"", "", "kinetic", "sum"}), 0.5 * mass * (5.0 + vz * vz), 1e-10 * mass);
}

TEST(Motion, a_sliding_sphere_ends_rolling_at_five_sevenths_of_its_speed) {
  Scene s;
  s.material("g", "grain", 1e10, 0.2, 2500.0);
  s.config.gravity = {0.0, 0.0, -9.81};
  s.config.contact.friction = 0.3;
  s.config.contact.restitution = 0.3;
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  s.sphere({0.0, 0.0, 0.05}, 0.05, {1.0, 0.0, 0.0});
  World w = s.world();
  ASSERT_TRUE(run_until(w, 4'000'000, [](const World& now) { return now.time > 0.12; }));
  EXPECT_NEAR(velocity_now(w, 0).x, 5.0 / 7.0, 1e-3);
  EXPECT_NEAR(state(w, 0).spin.y * 0.05, 5.0 / 7.0, 1e-3);
  // at t* = 2 v / (7 mu g) it had come 12 v^2 / (49 mu g), and has rolled since
  EXPECT_NEAR(state(w, 0).position.x, 0.0832137 + 5.0 / 7.0 * (w.time - 0.0970827), 2e-3 * 0.12);
}

TEST(Motion, a_sphere_on_an_incline_rolls_or_slides_as_friction_tells) {
  const double angle = 0.5, g = 9.81;
  for (const double share : {0.99, 1.01, 3.0}) {  // of the least friction for rolling
    const double mu = share * 2.0 / 7.0 * std::tan(angle);
    Scene s;
    s.material("g", "grain", 1e8, 0.2, 2500.0);
    s.config.gravity = {g * std::sin(angle), 0.0, -g * std::cos(angle)};
    s.config.contact.friction = mu;
    s.config.contact.restitution = 0.3;
    s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
    s.sphere({0.0, 0.0, 0.05 - 1e-8}, 0.05);
    World w = s.world();
    ASSERT_TRUE(run_until(w, 200'000, [](const World& now) { return now.time > 0.05; }));
    const double v = velocity_now(w, 0).x, t = w.time;
    ASSERT_TRUE(run_until(w, 200'000, [](const World& now) { return now.time > 0.1; }));
    const double expected = share > 1.0 ? 5.0 / 7.0 * g * std::sin(angle)
                                        : g * (std::sin(angle) - mu * std::cos(angle));
    EXPECT_NEAR((velocity_now(w, 0).x - v) / (w.time - t), expected, 5e-3 * expected) << share;
  }
}

/// Two equal linked spheres, K_n and K_t from the material; returns the period of a coordinate.
double period(World& w, double (*coordinate)(const World&), int periods = 20) {
  double first = -1.0, last = 0.0;
  int crossings = 0;
  double before = coordinate(w);
  for (long i = 0; i < 2'000'000 && crossings < periods + 1; ++i) {
    step(w);
    const double now = coordinate(w);
    if (before < 0.0 && now >= 0.0) {
      last = w.time - w.last_dt * now / (now - before);
      if (first < 0.0) first = last;
      ++crossings;
    }
    before = now;
  }
  return (last - first) / (crossings - 1);
}

Scene linked_pair() {
  Scene s;
  MaterialConfig& m = s.material("c", "concrete", 30e9, 0.2, 2400.0);
  m.tensile_strength = m.cohesion = 1e15;
  s.config.time.safety = 0.05;
  s.sphere({0.0, 0.0, 0.0}, 0.01);
  s.sphere({0.02, 0.0, 0.0}, 0.01);
  s.link(0, 1);
  return s;
}

TEST(Motion, the_four_modes_of_a_linked_pair_have_their_frequencies) {
  const double kn = [] { return linked_pair().world().concrete.stiffness.data()[0]; }();
  const World at_rest = linked_pair().world();
  const double kt = at_rest.concrete.groups[0].law.shear_ratio * kn, kr = kt * 1e-4;
  const double m = at_rest.elements.mass.data()[0], inertia = at_rest.elements.inertia.data()[0];
  {
    Scene s = linked_pair();
    s.model.velocity = {{-1e-3, 0.0, 0.0}, {1e-3, 0.0, 0.0}};
    World w = s.world();
    const double t = period(w, [](const World& now) { return state(now, 1).position.x - 0.02; });
    EXPECT_NEAR(2.0 * pi / t, std::sqrt(2.0 * kn / m), 1e-3 * std::sqrt(2.0 * kn / m)) << "axial";
  }
  {
    Scene s = linked_pair();
    s.model.spin = {{-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}};
    World w = s.world();
    const double t = period(w, [](const World& now) { return state(now, 1).spin.x; });
    EXPECT_NEAR(2.0 * pi / t, std::sqrt(2.0 * kr / inertia), 1e-3 * std::sqrt(2.0 * kr / inertia))
        << "twist";
  }
  {
    Scene s = linked_pair();
    s.model.spin = {{0.0, 0.0, -0.1}, {0.0, 0.0, 0.1}};
    World w = s.world();
    const double t = period(w, [](const World& now) { return state(now, 1).spin.z; });
    EXPECT_NEAR(2.0 * pi / t, std::sqrt(2.0 * kr / inertia), 1e-3 * std::sqrt(2.0 * kr / inertia))
        << "bending";
  }
  {
    // shear with rotation: both spin the same way, the centres move against it; no net angular
    // momentum
    Scene s = linked_pair();
    const double spin = 0.1;
    const double v = 2.0 * inertia * spin / (m * 0.02);
    s.model.spin = {{0.0, 0.0, spin}, {0.0, 0.0, spin}};
    s.model.velocity = {{0.0, v, 0.0}, {0.0, -v, 0.0}};
    World w = s.world();
    const double t = period(w, [](const World& now) { return state(now, 1).spin.z; });
    const double expected =
        std::sqrt(2.0 * kt * (1.0 / m + 1e-4 / inertia));  // 7 K_t / m for I = 0.4 m R^2
    EXPECT_NEAR(expected * expected, 7.0 * kt / m, 1e-9 * kt / m);
    EXPECT_NEAR(2.0 * pi / t, expected, 1e-3 * expected) << "shear";
  }
}

TEST(Motion, the_step_is_the_stability_limit_of_an_axial_pair) {
  for (const double safety : {0.99, 1.01}) {
    Scene s = linked_pair();
    s.config.materials[0].poisson = 1.0 / 3.9;  // K_t = 0
    s.config.time.safety = std::min(safety, 1.0);
    s.model.velocity = {{-1e-6, 0.0, 0.0}, {1e-6, 0.0, 0.0}};
    World w = s.world();
    const double kn = w.concrete.stiffness.data()[0], m = w.elements.mass.data()[0];
    EXPECT_LE(w.next_dt, std::min(safety, 1.0) * std::sqrt(2.0 * m / kn));
    EXPECT_GE(w.next_dt, std::min(safety, 1.0) * std::sqrt(2.0 * m / kn) * (1.0 - 1.0 / 32.0));
    const double forced = safety * std::sqrt(2.0 * m / kn);
    bool bounded = true;
    for (int i = 0; i < 3000; ++i) {
      w.next_dt = forced;
      step(w);
      bounded = bounded && std::fabs(state(w, 1).position.x - 0.02) < 1e-6;
      if (!bounded) break;
    }
    EXPECT_EQ(bounded, safety < 1.0) << safety;
  }
}

TEST(Motion, a_run_that_blows_up_is_stopped_by_the_element_s_number) {
  Scene s = linked_pair();
  World w = s.world();
  w.elements.state.data()[1].velocity = {1e9, 0.0, 0.0};
  step(w);
  const std::string text = find_unsound(w).text;
  EXPECT_NE(text.find("element 1 (all)"), std::string::npos) << text;
  w.elements.state.data()[0].position.x = std::nan("");
  EXPECT_EQ(find_unsound(w).id, 0);
}

/// A bar of steel links along x, its first element held.
Scene cantilever(int links, double spacing) {
  Scene s;
  s.material("b", "steel", 200e9, 0.3, 7850.0).yield = 1e15;
  s.config.time.safety = 0.5;
  const double radius = 0.004, area = pi * radius * radius;
  for (int i = 0; i <= links; ++i) {
    const double share = i == 0 || i == links ? 0.5 : 1.0;
    const double mass = share * 7850.0 * area * spacing;
    s.element({i * spacing, 0.0, 0.0}, radius, mass,
              mass * (spacing * spacing / 12.0 + radius * radius / 4.0));
    if (i > 0) s.link(i - 1, i, LinkKind::steel);
  }
  s.config.supports.push_back(
      {"clamp", "", {-1e-3, -1.0, -1.0}, {1e-3, 1.0, 1.0}, {"all"}, {}, 0.0});
  return s;
}

TEST(Motion, a_cantilever_bends_by_its_weight_as_beam_theory_says) {
  Scene s = cantilever(20, 0.02);
  s.config.gravity = {0.0, 0.0, -9.81};
  s.config.local_damping = 0.3;
  World w = s.world();
  double deepest = 0.0;
  for (int i = 0; i < 200'000; ++i) step(w);
  deepest = -state(w, 20).position.z;
  const double radius = 0.004, area = pi * radius * radius, second = 0.25 * area * radius * radius;
  const double load = 7850.0 * area * 9.81, length = 0.4;
  const double expected = load * std::pow(length, 4) / (8.0 * 200e9 * second);
  EXPECT_NEAR(deepest, expected, 0.01 * expected);
}

TEST(Motion, the_first_frequency_of_a_cantilever_is_that_of_the_beam) {
  Scene s = cantilever(40, 0.02);
  for (std::size_t i = 0; i < s.model.velocity.size(); ++i) {
    const double x = static_cast<double>(i) / 40.0;
    s.model.velocity[i].z = 1e-3 * x * x;
  }
  World w = s.world();
  const double t = period(
      w, [](const World& now) { return state(now, 40).position.z; }, 2);
  const double radius = 0.004, area = pi * radius * radius, second = 0.25 * area * radius * radius;
  const double expected = 3.5160153 / (0.8 * 0.8) * std::sqrt(200e9 * second / (7850.0 * area));
  EXPECT_NEAR(2.0 * pi / t, expected, 0.01 * expected);
}

TEST(Motion, a_pulled_bar_yields_and_hardens) {
  Scene s = cantilever(1, 0.02);
  s.config.materials[0].yield = 500e6;
  s.config.materials[0].hardening = 2e9;
  s.config.supports.push_back(
      {"grip", "", {0.019, -1.0, -1.0}, {0.021, 1.0, 1.0}, {"all"}, {0.2, 0.0, 0.0}, 0.0});
  World w = s.world();
  const double area = pi * 16e-6;
  double strain = 0.0;
  while (strain < 0.02) {
    step(w);
    strain = (state(w, 1).position.x - 0.02) / 0.02;
    const double force = -w.elements.force.data()[1].x;
    const double elastic = 200e9 * strain;
    const double tangent = 200e9 * 2e9 / (202e9);
    const double expected = elastic < 500e6 ? elastic : 500e6 + tangent * (strain - 500e6 / 200e9);
    ASSERT_NEAR(force, area * expected, 1e-9 * area * 200e9) << strain;
  }
  EXPECT_LT(balance(w).error_relative, 2e-3);  // the first step starts at full speed
}

/// A block of linked spheres on a loose cubic lattice, shaken.
Scene block(int side, double speed) {
  Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0).softening = 5.0;
  s.config.contact.restitution = 0.7;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < side; ++k)
        s.sphere({0.02 * i + 1e-3 * uniform(random), 0.02 * j + 1e-3 * uniform(random),
                  0.02 * k + 1e-3 * uniform(random)},
                 0.009 + 5e-4 * uniform(random),
                 {speed * uniform(random), speed * uniform(random), speed * uniform(random)},
                 {100.0 * speed * uniform(random), 0.0, 0.0});
  for (Index a = 0; a < s.model.size(); ++a)
    for (Index b = a + 1; b < s.model.size(); ++b)
      if (norm(s.model.position[static_cast<std::size_t>(b)] -
               s.model.position[static_cast<std::size_t>(a)]) < 0.0245)
        s.link(a, b);
  return s;
}

TEST(Motion, momentum_and_angular_momentum_survive_fracture_friction_and_dashpots) {
  Scene s = block(10, 10.0);
  s.config.time.safety = 0.1;  // some 20 steps a contact: fewer make its energy rough
  World w = s.world();
  double scale = 0.0;
  for (Index e = 0; e < w.elements.size(); ++e)
    scale += w.elements.mass.data()[e] * norm(state(w, e).velocity);
  // Before and after at the same instant of the scheme: velocities half a step back, positions on
  // time.
  step(w);
  const auto start = momentum(w);
  for (int i = 0; i < 6000; ++i) step(w);
  const auto end = momentum(w);
  EXPECT_GT(count(w).broken_of(LinkKind::concrete), 500);
  EXPECT_LT(norm(end.linear - start.linear), 1e-11 * scale);
  EXPECT_LT(norm(end.angular - start.angular), 1e-10 * scale * 0.2);
  EXPECT_LT(balance(w).error_relative, 1e-2);
}

TEST(Motion, the_energy_of_an_elastic_block_does_not_drift) {
  double fluctuation[2] = {0.0, 0.0};
  for (const int halving : {0, 1}) {
    Scene s = block(6, 0.01);
    s.config.time.safety = 0.2 / (1 + halving);
    s.config.materials[0].rolling_limit = 1e9;
    World w = s.world();
    const double start = balance(w).start;
    for (int i = 0; i < 2000 * (1 + halving); ++i) {
      step(w);
      if (i % 20 == 0)
        fluctuation[halving] =
            std::max(fluctuation[halving], std::fabs(balance(w).missing()) / start);
    }
  }
  EXPECT_LT(fluctuation[0], 1e-5);
  EXPECT_LT(fluctuation[1], fluctuation[0]);
}

TEST(Motion, a_prescribed_velocity_is_followed_and_its_work_is_booked) {
  Scene s = block(4, 0.0);
  s.config.supports.push_back(
      {"base", "", {-1.0, -1.0, -1.0}, {1.0, 1.0, 0.005}, {"all"}, {}, 0.0});
  s.config.supports.push_back(
      {"top", "", {-1.0, -1.0, 0.055}, {1.0, 1.0, 1.0}, {"x", "y", "z"}, {0.0, 0.0, 0.5}, 1e-4});
  World w = s.world();
  Index top = 0;
  for (Index e = 0; e < w.elements.size(); ++e)
    if (w.elements.motion.data()[e] >= 0) top = e;
  const double from = state(w, top).position.z;
  ASSERT_TRUE(run_until(w, 10'000, [](const World& now) { return now.time > 3e-4; }));
  EXPECT_NEAR(state(w, top).position.z - from, 0.5 * (w.time - 5e-5), 1e-7);
  const EnergyBalance e = balance(w);
  EXPECT_GT(e.work, 0.01);
  EXPECT_LT(e.error_relative, 2e-3);
}

TEST(Motion, the_same_scene_turned_or_shifted_moves_the_same) {
  const auto run = [](const auto& place, const auto& turn) {
    Scene s = block(5, 5.0);
    for (std::size_t i = 0; i < s.model.position.size(); ++i) {
      s.model.position[i] = place(s.model.position[i]);
      s.model.velocity[i] = turn(s.model.velocity[i]);
      s.model.spin[i] = turn(s.model.spin[i]);
    }
    World w = s.world();
    // Links that soften are past a bifurcation: rounding grows by 10 in 25 steps.
    for (int i = 0; i < 100; ++i) step(w);
    return w;
  };
  const auto same = [](const Vec3& x) { return x; };
  const auto quarter = [](const Vec3& x) { return Vec3{-x.y, x.x, x.z}; };
  const World w = run(same, same), turned = run(quarter, quarter);
  const World moved = run([](const Vec3& x) { return x + Vec3{4.0, -8.0, 2.0}; }, same);
  EXPECT_GT(count(w).broken_of(LinkKind::concrete), 0);
  for (Index e = 0; e < w.elements.size(); ++e) {
    EXPECT_LT(norm(state(turned, e).position - quarter(state(w, e).position)), 1e-9);
    EXPECT_LT(norm(state(moved, e).position - (state(w, e).position + Vec3{4.0, -8.0, 2.0})), 1e-9);
  }
}

}  // namespace motion_test
}  // namespace breccia::dem
