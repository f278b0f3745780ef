// Bodies in contact: the search finds them, collisions conserve, blocks slide and stay.

#include <gtest/gtest.h>

#include <set>

#include "core/random.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace contact_test {

using testing::far;
using testing::nodes;
using testing::rotated;
using testing::Scene;

double overlap(const World& w, Index a, Index b) {
  Vec2 xa[3], xb[3], v[3];
  split(nodes(w, a), xa, v);
  split(nodes(w, b), xb, v);
  return integral(overlap_of(Target::of(xa), Target::of(xb)), [](const Vec2&) { return 1.0; });
}

/// Every pair of triangles that overlaps is among the couples, at every step, on 1000 clouds.
TEST(FdemContact, search_finds_every_touching_pair_of_random_clouds) {
  int touching = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Scene scene;
    scene.material(1e6, 0.2, 1000.0).contact_stiffness = 0.01;
    const Random random{seed, 1};
    constexpr int count = 14;
    for (int i = 0; i < count; ++i) {
      const auto draw = [&](std::uint32_t d) {
        return random.uniform(static_cast<std::uint64_t>(i), d);
      };
      const double size = 0.05 + 0.25 * draw(0), angle = 6.3 * draw(1);
      const Vec2 center{draw(2), draw(3)};
      const Vec2 a = rotated({size, 0.0}, angle), b = rotated({size, 0.0}, angle + 1.6 + draw(4)),
                 c = rotated({size, 0.0}, angle + 4.0 + draw(5));
      scene.triangle("t", center + a, center + b, center + c, 0,
                     {100.0 * (draw(6) - 0.5), 100.0 * (draw(7) - 0.5)});
    }
    World w = scene.world();
    for (int i = 0; i < 3; ++i) {
      std::set<std::pair<Index, Index>> couples;
      for (Index c = 0; c < w.couples.size(); ++c)
        couples.insert({w.couples.pairs.a.data()[c], w.couples.pairs.b.data()[c]});
      for (Index a = 0; a < count; ++a)
        for (Index b = a + 1; b < count; ++b)
          if (overlap(w, a, b) > 1e-12) {
            ++touching;
            ASSERT_EQ(couples.count({a, b}), 1U) << "seed " << seed << ": " << a << ", " << b;
          }
      for (int k = 0; k < 10; ++k) step(w);
    }
  }
  EXPECT_GT(touching, 10000);
}

Scene two_discs(double speed, bool conservative, double offset = 0.0) {
  Scene scene;
  scene.material(1e9, 0.25, 2000.0);
  scene.config.time.safety = 0.2;
  scene.config.contact.conservative = conservative;
  const prepare::Mesh left = prepare::ringed_disc({-0.1001, -offset}, 0.1, 0.0125);
  const prepare::Mesh right = prepare::ringed_disc({0.1001, offset}, 0.1, 0.0125);
  scene.body("left", left, 0, {0.5 * speed, 0.0});
  scene.body("right", right, 0, {-0.5 * speed, 0.0});
  return scene;
}

/// Two discs of 384 triangles each meet and part.
TEST(FdemContact, colliding_discs_conserve_energy_and_momentum) {
  double drift[2];
  for (const bool conservative : {true, false}) {
    World w = two_discs(10.0, conservative, 0.03).world();
    const testing::Momentum before = testing::momentum(w);
    const double start = energies(w).balance.total();
    double moment = 0.0, largest = 0.0, stored = 0.0;
    for (Index t = 0; t < w.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k)
        moment += w.triangles.mass.data()[t] *
                  cross(nodes(w, t).at[k].position, nodes(w, t).at[k].velocity);
    const double end = 2.5e-3;
    while (w.time < end) {
      for (int i = 0; i < 20; ++i) step(w);
      const EnergyBalance b = energies(w).balance;
      largest = std::max(largest, std::abs(b.kinetic + b.elastic - start) / start);
      stored = std::max(stored, b.elastic / start);
    }
    drift[conservative ? 1 : 0] = std::abs(energies(w).balance.contact) / start;
    EXPECT_GT(stored, 0.2) << "they have met";
    EXPECT_LT(testing::value(w, "left", "velocity_x"), 0.0) << "and parted";
    EXPECT_LT(largest, 1e-3);
    const testing::Momentum after = testing::momentum(w);
    EXPECT_LT(norm(after.linear - before.linear), 1e-12 * before.size);
    double now = 0.0;
    for (Index t = 0; t < w.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k)
        now += w.triangles.mass.data()[t] *
               cross(nodes(w, t).at[k].position, testing::velocity_now(w, t, k));
    EXPECT_NEAR(now, moment, 1e-12 * before.size * 0.1);
  }
  std::printf("energy that contact lost: plain %.2e, conservative %.2e\n", drift[0], drift[1]);
  EXPECT_LT(drift[1], 1e-3);
}

/// Head on: the impulse is 2 m v less what stays as vibration, the same for both discs.
TEST(FdemContact, discs_bounce_back_alike) {
  World w = two_discs(2.0, true).world();
  testing::run_to(w, 3e-3);
  const double left = testing::value(w, "left", "momentum_x", "sum");
  const double right = testing::value(w, "right", "momentum_x", "sum");
  const double area = pi * 0.01;
  EXPECT_NEAR(left + right, 0.0, 1e-9 * area * 2000.0);
  EXPECT_LT(left, -0.9 * area * 2000.0);
  EXPECT_GT(left, -1.0 * area * 2000.0);
  EXPECT_NEAR(testing::value(w, "left", "momentum_y", "sum"), 0.0, 1e-9 * area * 2000.0);
}

/// A block on a base, gravity turned by the slope. The base is rigid: all of it is held.
struct Slope {
  Scene scene;
  double sag;  ///< overlap at rest
  static constexpr double g = 10.0, edge = 0.05;

  Slope(double angle, double mu, double speed, double base_edge) {
    MaterialConfig& m = scene.material(1e8, 0.2, 2000.0);
    m.friction = mu;
    m.damping = 0.5;  // the block bounces on its own elasticity, until that is damped away
    scene.config.gravity = rotated({0.0, -g}, angle);
    // per length: rho g cos H_block = 6 p sag / H over equal meshes
    sag = 2000.0 * g * std::cos(angle) * 0.1 * 0.0433 / (6.0 * 1e9);
    scene.body("base", prepare::equilateral_rectangle({{0.3, -0.5 * base_edge}, {1.2, base_edge}},
                                                      base_edge));
    scene.body("block", prepare::equilateral_rectangle({{0.0, 0.05 - sag}, {0.2, 0.1}}, edge), 0,
               {speed, 0.0});
    scene.support("ground", {-far, -far}, {far, far}, {"x", "y"}, {}, "base");
  }
};

TEST(FdemContact, block_slides_down_a_slope_at_g_times_sin_less_mu_cos) {
  constexpr double angle = 0.6, mu = 0.3;
  const double expected = Slope::g * (std::sin(angle) - mu * std::cos(angle));
  for (const double base : {0.05, 0.15}) {
    Slope slope(angle, mu, 0.0, base);
    World w = slope.scene.world();
    testing::run_to(w, 0.05);  // past the elastic slip of the start
    const double t0 = w.time, v0 = testing::value(w, "block", "velocity_x");
    testing::run_to(w, 0.2);
    const double a = (testing::value(w, "block", "velocity_x") - v0) / (w.time - t0);
    std::printf("base %.2f m: acceleration %.4f of %.4f m/s2\n", base, a, expected);
    EXPECT_NEAR(a, expected, 0.01 * expected) << base;
    EXPECT_LT(energies(w).balance.error_relative, 0.01);
  }
}

TEST(FdemContact, block_stops_after_v_squared_over_two_mu_g) {
  constexpr double mu = 0.5, speed = 1.0;
  for (const double base : {0.05, 0.15}) {
    World w = Slope(0.0, mu, speed, base).scene.world();
    const double start = testing::value(w, "block", "position_x");
    testing::run_to(w, 1.2 * speed / (mu * Slope::g));
    const double path = testing::value(w, "block", "position_x") - start;
    const double expected = speed * speed / (2.0 * mu * Slope::g);
    std::printf("base %.2f m: stops after %.5f of %.5f m\n", base, path, expected);
    EXPECT_NEAR(path, expected, 0.01 * expected) << base;
  }
}

/// A stone that falls on a corner turns, rubs, leaves and comes back; so do its edges. What
/// friction spends must be what body and base lose: the contact of deformable triangles, whose work
/// is booked apart, keeps its energy to 0.1 % without friction, and friction must not hide in it.
TEST(FdemContact, stone_that_falls_on_a_corner_loses_what_friction_spends) {
  for (const double mu : {0.0, 0.7}) {
    Scene scene;
    MaterialConfig& m = scene.material(1e9, 0.2, 2000.0);
    m.friction = mu;
    prepare::Mesh stone = prepare::crossed_rectangle({{0.0, 0.0}, {0.1, 0.06}}, 0.01);
    double lowest = 0.0;
    for (Vec2& x : stone.point) {
      x = rotated(x, 0.6);
      lowest = std::min(lowest, x.y);
    }
    for (Vec2& x : stone.point) x.y -= lowest - 1e-4;
    scene.body("stone", stone, 0, {2.0, -5.0});
    scene.body("base", prepare::crossed_rectangle({{0.0, -0.02}, {0.6, 0.04}}, 0.02));
    scene.support("ground", {-far, -far}, {far, -0.039}, {"x", "y"}, {}, "base");
    World w = scene.world();
    const double start = energies(w).balance.total();
    double least = 0.0, hidden = 0.0;  // change of friction; energy that contact counts
    for (double before = 0.0; w.time < 0.03;) {
      for (int i = 0; i < 50; ++i) step(w);
      const EnergyBalance b = energies(w).balance;
      least = std::min(least, b.friction - before);
      hidden = std::max(hidden, std::abs(b.contact));
      before = b.friction;
    }
    const EnergyBalance b = energies(w).balance;
    std::printf("mu %.1f: friction %.4f of the start, contact %.5f (at most %.5f), fell by %.6f\n",
                mu, b.friction / start, b.contact / start, hidden / start, least / start);
    EXPECT_LT(hidden, 0.005 * start);
    EXPECT_GT(b.friction, mu > 0.0 ? 0.05 * start : -1e-300);
    EXPECT_GT(least, -0.005 * start) << "friction gives nothing back";
    EXPECT_LT(b.error_relative, 2e-4);  // it flies by steps 2 times as long as it rubs by
  }
}

/// Below the angle of friction it moves by its weight over the tangential springs, and stays.
TEST(FdemContact, block_stays_on_a_gentle_slope) {
  constexpr double angle = 0.3, mu = 0.5;
  World w = Slope(angle, mu, 0.0, 0.05).scene.world();
  testing::run_to(w, 0.05);  // it has come to rest
  const double start = testing::value(w, "block", "position_x");
  testing::run_to(w, 0.1);
  const double crept = testing::value(w, "block", "position_x") - start;
  // a free one would have gone 3 g sin(angle) 0.05^2 / 2 = 11 mm on; both faces of each of four
  // edges of the block hold with k_t = p_t
  const double elastic = 0.2 * 0.1 * 2000.0 * Slope::g * std::sin(angle) / (4.0 * 2.0 * 1e8);
  EXPECT_LT(std::abs(crept), elastic) << "creeps";
}

}  // namespace contact_test
}  // namespace breccia::fdem
