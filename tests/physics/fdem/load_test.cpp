// Supports, loads, gravity, in-situ stress, absorbing edges.

#include <gtest/gtest.h>

#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace {

using testing::far;
using testing::nodes;
using testing::run_to;
using testing::Scene;

TEST(FdemLoads, free_fall_is_a_parabola_and_its_work_is_booked) {
  Scene scene;
  scene.material(1e8).joints = "intrinsic";
  scene.config.gravity = {1.0, -10.0};
  scene.body("block", prepare::crossed_rectangle({{0.0, 0.0}, {0.2, 0.2}}, 0.1));
  World w = scene.world();
  run_to(w, 0.05);
  EXPECT_NEAR(testing::value(w, "block", "position_y"), -5.0 * w.time * w.time, 1e-9);
  EXPECT_NEAR(testing::value(w, "block", "position_x"), 0.5 * w.time * w.time, 1e-9);
  const EnergyBalance b = energies(w).balance;
  const double mass = 2650.0 * 0.04, speed = w.time * std::sqrt(101.0);
  // the ledger's kinetic energy leaves m (a dt)^2 / 8 out, which a start at rest does not have
  const double half_step = 0.125 * mass * 101.0 * w.last_dt * w.last_dt;
  EXPECT_NEAR(b.kinetic + half_step, 0.5 * mass * speed * speed, 1e-9 * b.kinetic);
  EXPECT_NEAR(b.work, b.kinetic + half_step, 1e-9 * b.kinetic);
}

/// A force pushes a free body by F = m a; pressure all around does not move it.
TEST(FdemLoads, force_accelerates_and_pressure_all_around_does_not) {
  for (const bool force : {true, false}) {
    Scene scene;
    scene.material(1e8);
    prepare::Mesh mesh = prepare::crossed_rectangle({{0.0, 0.0}, {0.2, 0.1}}, 0.05);
    prepare::jitter(mesh, 0.2, {3, 1}, {});
    scene.body("block", mesh);
    LoadConfig& l =
        scene.load("load", force ? "force" : "pressure", {force ? 0.0999 : -far, -far}, {far, far});
    l.force = {100.0, 0.0};
    l.pressure = 1e4;
    l.history.ramp = 2e-3;
    World w = scene.world();
    run_to(w, 0.01);
    const double mass = 2650.0 * 0.02;
    const double v = testing::value(w, "block", "momentum_x", "sum") / mass;
    if (force)
      // the loaded edges stretch by 1e-5, and the force with them
      EXPECT_NEAR(v, 100.0 / mass * (w.time - 0.5 * w.last_dt - 1e-3), 1e-5 * v);
    else
      EXPECT_NEAR(v, 0.0, 1e-12);
    EXPECT_LT(energies(w).balance.error_relative, 1e-5);
  }
}

/// A column under its weight: the support carries it, the stress grows with the depth.
TEST(FdemLoads, column_stands_on_its_support) {
  Scene scene;
  scene.material(1e8, 0.0, 2000.0).joints = "intrinsic";
  scene.config.gravity = {0.0, -10.0};
  scene.config.local_damping = 0.7;
  scene.body("column", prepare::crossed_rectangle({{0.0, 0.5}, {0.2, 1.0}}, 0.1));
  scene.support("ground", {-far, -far}, {far, 1e-9}, {"y"});
  World w = scene.world();
  run_to(w, 0.5);
  const double weight = 2000.0 * 10.0 * 0.2;
  // what the ground's corners do not carry by themselves
  const double own = testing::value(w, "ground", "force_y", "sum");
  double mass = 0.0;
  for (const NodeSet& set : w.sets)
    if (set.name == "ground")
      for (const Index n : set.nodes) mass += w.triangles.mass.data()[n / 3];
  EXPECT_NEAR(-own + 10.0 * mass, weight, 1e-3 * weight);
  const std::vector<Sym2> stress = stresses(w);
  double low = 0.0, sum = 0.0;
  int count = 0;
  for (Index t = 0; t < w.triangles.size(); ++t) {
    double y = 0.0;
    for (const NodeState& n : nodes(w, t).at) y += n.position.y / 3.0;
    low = std::min(low, stress[static_cast<std::size_t>(t)].yy);
    if (std::abs(y - 0.5) > 0.1) continue;
    sum += stress[static_cast<std::size_t>(t)].yy;
    ++count;
  }
  EXPECT_NEAR(sum / count, -2000.0 * 10.0 * 0.5, 0.01 * 1e4);
  EXPECT_LT(low, -1.7e4);
}

/// An in-situ stress with pressure on the rim that balances it: nothing moves, with joints or
/// without, and with the rim held it is the same.
TEST(FdemLoads, in_situ_stress_is_in_equilibrium_from_the_start) {
  for (const bool joints : {true, false})
    for (const bool held : {true, false}) {
      Scene scene;
      MaterialConfig& m = scene.material(30e9, 0.25);
      if (joints) m.joints = "intrinsic";
      scene.config.in_situ = {-8e6, held ? -5e6 : -8e6, held ? 1.5e6 : 0.0};
      prepare::Mesh mesh = prepare::crossed_rectangle({{0.0, 0.0}, {0.4, 0.4}}, 0.1);
      prepare::jitter(mesh, 0.2, {5, 1}, {});
      scene.body("rock", mesh);
      if (held) {
        const double rim = 0.2 - 1e-9;
        scene.support("left", {-far, -far}, {-rim, far}, {"x", "y"});
        scene.support("right", {rim, -far}, {far, far}, {"x", "y"});
        scene.support("below", {-rim, -far}, {rim, -rim}, {"x", "y"});
        scene.support("above", {-rim, rim}, {rim, far}, {"x", "y"});
      } else {
        scene.load("rim", "pressure", {-far, -far}, {far, far}).pressure = 8e6;
      }
      World w = scene.world();
      const std::vector<Sym2> stress = stresses(w);
      for (const Sym2& s : stress) EXPECT_NEAR(s.xx, -8e6, 1e-6 * 8e6);
      for (int i = 0; i < 300; ++i) step(w);
      double fastest = 0.0;
      for (Index t = 0; t < w.triangles.size(); ++t)
        for (const NodeState& n : nodes(w, t).at) fastest = std::max(fastest, norm(n.velocity));
      // a stress s that is not balanced would move it with s / (rho c), 0.7 m/s
      EXPECT_LT(fastest, 1e-9) << joints << held;
      EXPECT_LT(std::abs(energies(w).balance.work), 1e-6);
    }
}

/// The support's velocity follows its table; its work goes into what it moves.
TEST(FdemLoads, support_follows_its_table_and_books_its_work) {
  Scene scene;
  scene.material(1e8).joints = "intrinsic";
  scene.body("block", prepare::crossed_rectangle({{0.0, 0.0}, {0.2, 0.2}}, 0.1));
  SupportConfig& s = scene.support("grip", {-far, -far}, {-0.0999, far}, {"x"}, {2.0, 0.0});
  s.history.times = {0.0, 1e-3, 2e-3};
  s.history.factors = {0.0, 1.0, 0.0};
  World w = scene.world();
  const double start = testing::value(w, "grip", "position_x");
  run_to(w, 2.5e-3);
  EXPECT_NEAR(testing::value(w, "grip", "position_x") - start, 2.0 * 1e-3, 1e-3 * 2e-3);
  EXPECT_EQ(testing::value(w, "grip", "velocity_x", "max"), 0.0);
  const EnergyBalance b = energies(w).balance;
  EXPECT_GT(b.work, 0.0);
  EXPECT_LT(b.error_relative, 1e-4);
}

/// A pulse in a bar between rollers: share of its velocity that the right end throws back.
/// @param absorbed  impedance of that end over the bar's
double reflected(double absorbed) {
  Scene scene;
  scene.material();
  scene.config.plane = "strain";
  constexpr double edge = 0.005, length = 0.3;
  scene.body("bar", prepare::crossed_rectangle({{0.5 * length, 0.0}, {length, 0.01}}, edge));
  scene.support("below", {-far, -far}, {far, -0.00499}, {"y"});
  scene.support("above", {-far, 0.00499}, {far, far}, {"y"});
  HistoryConfig& h = scene.load("end", "absorbing", {length - 1e-6, -far}, {far, far}).history;
  h.times = {0.0};
  h.factors = {absorbed};
  World w = scene.world();
  // a bell of velocity and stress that runs to the right: u = f(x - c t)
  constexpr double c = 5212.47, width = 0.02, middle = 0.12;
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (NodeState& n : nodes(w, t).at) {
      const double s = (n.position.x - middle) / width, bell = std::exp(-s * s);
      n.velocity.x = bell;
      n.position.x -= width * 0.5 * std::sqrt(testing::pi) * (std::erf(s) + 1.0) / c;
    }
  evaluate_forces(w);
  run_to(w, (length - middle + 0.12) / c);  // there and back to x = 0.18
  double most = 0.0;
  for (Index t = 0; t < w.triangles.size(); ++t)
    for (const NodeState& n : nodes(w, t).at) most = std::max(most, std::abs(n.velocity.x));
  return most;
}

/// An end of a times the bar's impedance throws (1 - a) / (1 + a) back.
TEST(FdemLoads, absorbing_edge_throws_less_than_a_hundredth_back) {
  const double back = reflected(1.0);
  std::printf("reflected: %.4f\n", back);
  EXPECT_LT(back, 0.01);
  for (const double a : {0.0, 0.5, 2.0})
    EXPECT_NEAR(reflected(a), std::abs((1.0 - a) / (1.0 + a)), 0.01) << a;
}

/// A plate that absorbs all around comes to rest: the time step must allow for the edges, too.
TEST(FdemLoads, plate_with_absorbing_rim_comes_to_rest) {
  for (const bool joints : {false, true}) {
    Scene scene;
    MaterialConfig& m = scene.material();
    if (joints) m.joints = "intrinsic";
    scene.body("plate", prepare::equilateral_rectangle({{0.0, 0.0}, {0.1, 0.1}}, 0.01));
    scene.load("rim", "absorbing", {-far, -far}, {far, far});
    World w = scene.world();
    testing::stir(w, [](const Vec2& x) { return Vec2{100.0 * x.x, -50.0 * x.y + 20.0 * x.x}; });
    begin_ledger(w);
    const double start = energies(w).balance.kinetic;
    run_to(w, 2e-4);  // ten times across
    const EnergyBalance b = energies(w).balance;
    EXPECT_LT(b.kinetic, 0.01 * start) << joints;
    EXPECT_LT(b.error_relative, 0.01) << joints;
  }
}

}  // namespace
}  // namespace breccia::fdem
