// Contact by potential: reference values, balance of forces and moments, gradient of the energy.

#include "fdem/laws/potential_contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <random>

#include "fdem/stepping/step.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace potential_contact_test {

using Corner = std::array<Vec2, 3>;

/// Two triangles that touch, by the kernel of a step.
struct Touching {
  Vec2 a[3], b[3];
  double friction = 0.0;

  CoupleForce forces(bool conservative = false) const {
    Buffer<TriangleNodes> nodes(Space::host, 2);
    for (int k = 0; k < 3; ++k) {
      nodes.data()[0].at[k].position = a[k];
      nodes.data()[1].at[k].position = b[k];
    }
    Buffer<Index> material(Space::host, 2);
    Buffer<ContactPair> law(Space::host, 1);
    law.data()[0] = {1.0, 0.1, friction};
    Buffer<Index> first(Space::host, 1), second(Space::host, 1);
    second.data()[0] = 1;
    Buffer<Index> born(Space::host, 1);
    born.data()[0] = -1;
    Buffer<CoupleState> state(Space::host, 1);
    Buffer<CoupleForce> force(Space::host, 1);
    Buffer<CouplePhase> phase(Space::host, 1);
    phase.data()[0] = CouplePhase::acts;
    const CoupleForces<double> kernel{0.0,
                                      conservative,
                                      {},
                                      std::as_const(nodes).view(),
                                      std::as_const(material).view(),
                                      std::as_const(law).view(),
                                      1,
                                      std::as_const(first).view(),
                                      std::as_const(second).view(),
                                      std::as_const(born).view(),
                                      {},
                                      state.view(),
                                      force.view(),
                                      phase.view()};
    kernel(0);
    return force.data()[0];
  }
  /// p = 1
  double energy() const {
    const Target ta = Target::of(a), tb = Target::of(b);
    const Polygon over = overlap_of(ta, tb);
    return potential_integral(ta, over) + potential_integral(tb, over);
  }
};

const Touching example{{{0.0, 0.0}, {1.0, 0.0}, {0.2, 0.9}}, {{0.7, 0.05}, {1.6, 0.4}, {0.9, 1.1}}};

void expect_forces(const Vec2 (&f)[3], const Vec2 (&expected)[3]) {
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(f[k].x, expected[k].x, 6e-13);
    EXPECT_NEAR(f[k].y, expected[k].y, 6e-13);
  }
}

TEST(PotentialContact, has_the_reference_integrals) {
  const Target a = Target::of(example.a), b = Target::of(example.b);
  const Polygon over = overlap_of(a, b);
  EXPECT_NEAR(integral(over, [](const Vec2&) { return 1.0; }), .020816468789, 6e-13);
  EXPECT_NEAR(potential_integral(a, over), .004368677290, 6e-13);
  EXPECT_NEAR(potential_integral(b, over), .002269093754, 6e-13);
  EXPECT_NEAR(example.energy(), .006637771044, 6e-13);
}

TEST(PotentialContact, has_the_reference_forces) {
  const CoupleForce f = example.forces();
  expect_forces(f.on_a.at, {{-.007231179734, -.003697424429},
                            {-.052391620654, -.039976784569},
                            {-.015197489182, -.006981265790}});
  expect_forces(f.on_b.at, {{.064425376309, .042923818110},
                            {.001397047341, .006239820057},
                            {.008997865920, .001491836621}});
}

TEST(PotentialContact, has_the_reference_conservative_forces) {
  const CoupleForce f = example.forces(true);
  expect_forces(f.on_a.at, {{-.002862502445, .000185844273},
                            {-.056760297944, -.039005967393},
                            {-.015197489182, -.011835351667}});
  expect_forces(f.on_b.at, {{.066240651313, .044739093113},
                            {-.001325865164, .006758470058},
                            {.009905503422, -.000842088384}});
}

/// Random triangles with a smallest angle that meshes have.
class Pairs {
 public:
  Touching next() {
    Touching t;
    do {
      draw(t.a);
      draw(t.b);
    } while (!(t.energy() > 0.0));
    return t;
  }

 private:
  void draw(Vec2 (&x)[3]) {
    std::uniform_real_distribution<double> at(0.0, 1.0);
    double area = 0.0, longest = 0.0;
    do {
      for (Vec2& p : x) p = {at(random_), at(random_)};
      area = cross(x[1] - x[0], x[2] - x[0]);
      longest = 0.0;
      for (int k = 0; k < 3; ++k)
        longest = std::max(longest, dot(x[(k + 1) % 3] - x[k], x[(k + 1) % 3] - x[k]));
    } while (area < 0.3 * longest || longest < 0.04);
  }
  std::mt19937_64 random_{11};
};

TEST(PotentialContact, one_area_coordinate_has_the_bits_of_all) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  const auto point = [&] { return Vec2{place(random), place(random)}; };
  for (int turn = 0; turn < 1000; ++turn) {
    const Vec2 corner[3] = {point(), point(), point()};
    const Target target = Target::of(corner);
    for (const Vec2& p : {point(), corner[turn % 3], 0.5 * (corner[0] + corner[1])}) {
      double all[3];
      target.coordinates(p, all);
      for (int k = 0; k < 3; ++k) {
        const double one = target.coordinate(k, p);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(one), std::bit_cast<std::uint64_t>(all[k]));
      }
    }
  }
}

TEST(PotentialContact, forces_and_moments_of_random_pairs_sum_to_zero) {
  Pairs pairs;
  for (int i = 0; i < 100000; ++i) {
    Touching t = pairs.next();
    t.friction = 0.5;
    const CoupleForce f = t.forces(i % 2 == 0);
    Vec2 sum{};
    double moment = 0.0, size = 0.0;
    for (int k = 0; k < 3; ++k) {
      sum += f.on_a.at[k] + f.on_b.at[k];
      moment += cross(t.a[k], f.on_a.at[k]) + cross(t.b[k], f.on_b.at[k]);
      size += norm(f.on_a.at[k]) + norm(f.on_b.at[k]);
    }
    // rounding of twelve edges with area coordinates up to 10, relative to what is added, not to
    // what is left of it: at least p times the overlap
    const double scale = size + t.energy();
    ASSERT_LT(norm(sum), 3e-14 * scale) << i;
    ASSERT_LT(std::abs(moment), 3e-14 * scale) << i;
  }
}

/// Forces of two rigid triangles are minus the gradient of their energy.
TEST(PotentialContact, pushes_rigid_triangles_down_their_energy) {
  Pairs pairs;
  constexpr double d = 1e-6;
  for (int i = 0; i < 2000; ++i) {
    const Touching t = pairs.next();
    const CoupleForce f = t.forces();
    const Vec2 total = f.on_a.at[0] + f.on_a.at[1] + f.on_a.at[2];
    double moment = 0.0;
    for (int k = 0; k < 3; ++k) moment += cross(t.a[k], f.on_a.at[k]);
    const auto slope = [&](auto&& moved) {
      Touching up = t, down = t;
      for (int k = 0; k < 3; ++k) {
        up.a[k] = moved(t.a[k], d);
        down.a[k] = moved(t.a[k], -d);
      }
      return (up.energy() - down.energy()) / (2.0 * d);
    };
    // The energy has a third derivative of the order of the slopes, up to 30, squared.
    constexpr double tolerance = 1e-8;
    EXPECT_NEAR(total.x, -slope([](Vec2 x, double s) { return x + Vec2{s, 0.0}; }), tolerance);
    EXPECT_NEAR(total.y, -slope([](Vec2 x, double s) { return x + Vec2{0.0, s}; }), tolerance);
    EXPECT_NEAR(moment, -slope([](Vec2 x, double s) { return testing::rotated(x, s); }), tolerance);
  }
}

/// The conservative forces are minus its gradient for every corner by itself; the plain ones not.
TEST(PotentialContact, conservative_forces_are_the_gradient_for_every_corner) {
  Pairs pairs;
  constexpr double d = 1e-6;
  double plain = 0.0;
  for (int i = 0; i < 2000; ++i) {
    Touching t = pairs.next();
    const CoupleForce f = t.forces(true), without = t.forces(false);
    for (int k = 0; k < 6; ++k)
      for (double Vec2::*c : {&Vec2::x, &Vec2::y}) {
        Vec2* const corner = k < 3 ? &t.a[k] : &t.b[k - 3];
        const Vec2* const push = k < 3 ? &f.on_a.at[k] : &f.on_b.at[k - 3];
        const Vec2* const alone = k < 3 ? &without.on_a.at[k] : &without.on_b.at[k - 3];
        double& x = corner->*c;
        const double start = x;
        x = start + d;
        const double up = t.energy();
        x = start - d;
        const double slope = (up - t.energy()) / (2.0 * d);
        x = start;
        EXPECT_NEAR(push->*c, -slope, 1e-8) << i;
        plain = std::max(plain, std::abs(alone->*c + slope));
      }
  }
  EXPECT_GT(plain, 0.01);
}

/// A face pressed on an equal one: 6 p / H per depth and length, less by the depth over H.
TEST(PotentialContact, face_on_face_has_the_stiffness_that_the_time_step_assumes) {
  const double height = std::sqrt(0.75);
  for (const double depth : {1e-4, 1e-2, 5e-2}) {
    const Touching t{{{0.0, 0.0}, {1.0, 0.0}, {0.5, height}},
                     {{0.0, depth}, {0.5, depth - height}, {1.0, depth}}};
    const CoupleForce f = t.forces();
    const double push = f.on_a.at[0].y + f.on_a.at[1].y + f.on_a.at[2].y;
    const double share = push / (6.0 * depth / height);
    EXPECT_LT(share, 1.0);
    EXPECT_GT(share, 1.0 - 3.0 * depth / height);
    EXPECT_NEAR(f.on_a.at[0].x + f.on_a.at[1].x + f.on_a.at[2].x, 0.0, 1e-12);
  }
}

/// A couple that touched while nothing moved must let go when it has parted.
TEST(PotentialContact, nothing_is_left_when_triangles_part) {
  testing::Scene scene;
  scene.material(1e9);
  scene.triangle("a", {0.0, 0.0}, {1.0, 0.0}, {0.2, 0.9});
  scene.triangle("b", {0.99, 0.0}, {1.6, 0.4}, {0.9, 1.1});
  World w = scene.world();
  ASSERT_EQ(w.couples.size(), 1);
  EXPECT_GT(norm(w.couples.history.force.in_double.data()[0].on_a.at[1]), 0.0);
  for (NodeState& n : testing::nodes(w, 1).at) n.position.x += 1.0;
  HostRun{}.couple_forces(w);
  for (int k = 0; k < 3; ++k)
    EXPECT_EQ(norm(w.couples.history.force.in_double.data()[0].on_a.at[k]), 0.0);
}

TEST(PotentialContact, finds_which_triangles_do_not_meet) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  int apart = 0, together = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    Vec2 x[2][3];
    for (Vec2(&corners)[3] : x) {
      for (Vec2& corner : corners) corner = {anywhere(random), anywhere(random)};
      if (cross(corners[1] - corners[0], corners[2] - corners[0]) < 0.0)
        std::swap(corners[1], corners[2]);
    }
    const Target of_a = Target::of(x[0]), of_b = Target::of(x[1]);
    const bool separate = outside(x[0], of_b) || outside(x[1], of_a);
    const Polygon over = overlap_of(of_a, of_b);
    const double area = integral(over, [](const Vec2&) { return 1.0; });
    EXPECT_TRUE(separate == !(area > 0.0) || area < 1e-6) << "trial " << trial;
    for (int k = 0; k < 3 && separate; ++k) {
      EdgeOverlap o;
      const int next = (k + 1) % 3;
      EXPECT_FALSE(overlap_of_edge(x[0][k], x[0][next], of_b, o)) << "trial " << trial;
      EXPECT_FALSE(overlap_of_edge(x[1][k], x[1][next], of_a, o)) << "trial " << trial;
    }
    (separate ? apart : together) += 1;
  }
  EXPECT_GT(apart, 1'000);
  EXPECT_GT(together, 1'000);
}

}  // namespace potential_contact_test
}  // namespace breccia::fdem
