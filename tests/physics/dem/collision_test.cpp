// Collisions: duration, overlap, restitution; Chung & Ooi 2011, tests 1 to 8.

#include <gtest/gtest.h>

#include "scene.hpp"

namespace breccia::dem {
namespace collision_test {

using testing::Scene;
using testing::state;

struct Collision {
  double duration = 0.0, deepest = 0.0, hardest = 0.0;  ///< [s], [m], [N]
  Vec3 velocity{}, spin{};                              ///< of element 0 afterwards
};

/// Steps through the one contact of a scene: element 0 with element 1, or with the wall.
Collision collide(World& w) {
  Collision c;
  double begin = -1.0;
  const bool wall = !w.walls.empty();
  for (int i = 0; i < 2'000'000; ++i) {
    step(w);
    const ElementState& a = state(w, 0);
    const double overlap =
        wall ? a.radius - dot(a.position - w.walls[0].point, w.walls[0].normal)
             : a.radius + state(w, 1).radius - norm(state(w, 1).position - a.position);
    const double force = norm(w.elements.force.data()[0]);
    if (overlap > 0.0 && begin < 0.0) begin = w.time - w.last_dt;
    c.deepest = std::max(c.deepest, overlap);
    c.hardest = std::max(c.hardest, force);
    if (begin >= 0.0 && overlap <= 0.0) {
      c.duration = w.time - begin;
      c.velocity = a.velocity;
      c.spin = a.spin;
      return c;
    }
  }
  ADD_FAILURE() << "the contact never ended";
  return c;
}

TEST(Collision, a_linear_contact_lasts_pi_root_m_over_k) {
  Scene s;
  s.material("g", "grain", 1e9, 0.2, 2500.0);
  s.config.time.safety = 0.01;
  s.sphere({0.0, 0.0, 0.0}, 0.01, {0.5, 0.0, 0.0});
  s.sphere({0.0201, 0.0, 0.0}, 0.01, {-0.5, 0.0, 0.0});
  World w = s.world();
  const double k = w.given->contact_pairs.data()[0].normal * 1e-4 / 0.02;
  const double reduced = 0.5 * s.model.mass[0], omega = std::sqrt(k / reduced);
  const Collision c = collide(w);
  EXPECT_NEAR(c.duration, pi / omega, 0.01 * pi / omega);
  EXPECT_NEAR(c.deepest, 1.0 / omega, 1e-3 / omega);
  EXPECT_NEAR(c.velocity.x, -0.5, 1e-4);
}

TEST(Collision, the_restitution_is_what_the_case_asks) {
  for (const char* law : {"linear", "hertz"})
    for (const double e : {0.2, 0.4, 0.6, 0.8, 0.98}) {
      Scene s;
      s.material("g", "grain", 1e9, 0.2, 2500.0);
      s.config.contact.law = law;
      s.config.contact.restitution = e;
      s.config.time.max_step = 2e-8;
      s.sphere({0.0, 0.0, 0.0}, 0.01, {0.5, 0.0, 0.0});
      s.sphere({0.02001, 0.0, 0.0}, 0.01, {-0.5, 0.0, 0.0});
      World w = s.world();
      EXPECT_NEAR(-collide(w).velocity.x / 0.5, e, 2e-3) << law;
    }
}

TEST(Collision, restitution_and_ledger_hold_at_the_programs_own_step) {
  for (const char* law : {"linear", "hertz"})
    for (const bool wall : {false, true})
      for (const double e : {0.2, 0.5}) {
        double mean = 0.0, missing = 0.0;
        for (int phase = 0; phase < 4; ++phase) {
          Scene s;
          s.material("g", "grain", 1e9, 0.2, 2500.0);
          s.config.contact.law = law;
          s.config.contact.restitution = e;
          s.sphere({0.0, 0.0, 0.0}, 0.01, {0.5, 0.0, 0.0});
          const double gap = 1e-5 + 6e-6 * phase;
          if (wall)
            s.wall({0.01 + gap, 0.0, 0.0}, {-1.0, 0.0, 0.0});
          else
            s.sphere({0.02 + 2.0 * gap, 0.0, 0.0}, 0.01, {-0.5, 0.0, 0.0});
          World w = s.world();
          mean -= collide(w).velocity.x / 0.5 / 4.0;
          missing = std::max(missing, balance(w).error_relative);
        }
        EXPECT_NEAR(mean, e, 0.05) << law << (wall ? " wall" : "");
        // work of the trapezoid is that of a linear spring, and of Hertz's to second order
        EXPECT_LT(missing, law[0] == 'l' ? 1e-4 : 2e-3) << law << (wall ? " wall" : "");
      }
}

struct Pair {
  double young, poisson, density, deepest, hardest, duration;
};

/// A scene of one sphere and, if `other`, its mirror image; Hertz without friction.
Scene hertz(const Pair& m, double radius, double restitution, double friction) {
  Scene s;
  s.material("m", "grain", m.young, m.poisson, m.density);
  s.config.contact = {"hertz", friction, restitution, 0.0, 0.0};
  // one hundredth of the Rayleigh time
  s.config.time.max_step = 0.01 * pi * radius *
                           std::sqrt(m.density * 2.0 * (1.0 + m.poisson) / m.young) /
                           (0.1631 * m.poisson + 0.8766);
  return s;
}

TEST(ChungOoi, test_1_two_spheres_collide_as_hertz_says) {
  for (const Pair& m : {Pair{48e9, 0.20, 2800.0, 274.113e-6, 10.6969e3, 40.339e-6},
                        Pair{20e9, 0.25, 2500.0, 368.304e-6, 7.1082e3, 54.201e-6}}) {
    Scene s = hertz(m, 0.01, 1.0, 0.0);
    s.sphere({0.0, 0.0, 0.0}, 0.01, {10.0, 0.0, 0.0});
    s.sphere({0.020001, 0.0, 0.0}, 0.01, {-10.0, 0.0, 0.0});
    World w = s.world();
    const Collision c = collide(w);
    EXPECT_NEAR(c.deepest, m.deepest, 5e-3 * m.deepest);
    EXPECT_NEAR(c.hardest, m.hardest, 5e-3 * m.hardest);
    EXPECT_NEAR(c.duration, m.duration, 1e-2 * m.duration);
  }
}

TEST(ChungOoi, test_2_a_sphere_bounces_off_a_rigid_plane) {
  for (const Pair& m : {Pair{70e9, 0.30, 2699.0, 49.7172e-6, 11.3699e3, 731.657e-6},
                        Pair{40e9, 0.35, 1800.0, 52.1233e-6, 7.2327e3, 767.066e-6}}) {
    Scene s = hertz(m, 0.1, 1.0, 0.0);
    s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
    s.sphere({0.0, 0.0, 0.1000001}, 0.1, {0.0, 0.0, -0.2});
    World w = s.world();
    const Collision c = collide(w);
    EXPECT_NEAR(c.deepest, m.deepest, 5e-3 * m.deepest);
    EXPECT_NEAR(c.hardest, m.hardest, 5e-3 * m.hardest);
    EXPECT_NEAR(c.duration, m.duration, 1e-2 * m.duration);
  }
}

TEST(ChungOoi, test_3_the_rebound_has_the_asked_restitution) {
  for (const Pair& m : {Pair{380e9, 0.23, 4000.0, 0, 0, 0}, Pair{100e9, 0.25, 7000.0, 0, 0, 0}})
    for (const double e : {0.2, 0.4, 0.6, 0.8, 1.0}) {
      Scene s = hertz(m, 0.0025, e, 0.0);
      s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
      s.sphere({0.0, 0.0, 0.00250001}, 0.0025, {0.0, 0.0, -3.9});
      World w = s.world();
      EXPECT_NEAR(collide(w).velocity.z / 3.9, e, 4e-3);
    }
}

TEST(ChungOoi, test_4_an_oblique_impact_with_gross_sliding_follows_coulomb) {
  const double mu = 0.092, e = 0.98, v = 3.9, radius = 0.0025;
  for (const double degrees : {30.0, 45.0, 60.0, 75.0}) {
    const double angle = degrees * pi / 180.0;
    Scene s = hertz({380e9, 0.23, 4000.0, 0, 0, 0}, radius, e, mu);
    s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
    s.sphere({0.0, 0.0, radius + 1e-8}, radius, {v * std::sin(angle), 0.0, -v * std::cos(angle)});
    World w = s.world();
    const Collision c = collide(w);
    EXPECT_NEAR(c.velocity.x / (v * std::sin(angle)), 1.0 - mu * (1.0 + e) / std::tan(angle), 5e-3);
    // rolls forward: about +y for a motion along +x
    EXPECT_NEAR(c.spin.y, 2.5 * mu * (1.0 + e) * v * std::cos(angle) / radius,
                1e-2 * 2.5 * mu * (1.0 + e) * v * std::cos(angle) / radius);
  }
}

TEST(ChungOoi, test_4_a_steep_impact_sticks_as_mindlin_says) {
  const double v = 3.9, radius = 0.0025;
  for (const auto& [degrees, ratio] : {std::pair{5.0, 0.8904}, {15.0, 0.6275}, {25.0, 0.6279}}) {
    const double angle = degrees * pi / 180.0;
    Scene s = hertz({380e9, 0.23, 4000.0, 0, 0, 0}, radius, 0.98, 0.092);
    s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
    s.sphere({0.0, 0.0, radius + 1e-8}, radius, {v * std::sin(angle), 0.0, -v * std::cos(angle)});
    World w = s.world();
    EXPECT_NEAR(collide(w).velocity.x / (v * std::sin(angle)), ratio, 0.03 * ratio) << degrees;
  }
}

TEST(ChungOoi, test_5_tangential_rebound_of_a_small_sphere) {
  const double mu = 0.3, vn = 5.0, radius = 1e-5;
  for (const auto& [in, out] :
       {std::pair{0.333, 0.2653}, {1.333, 0.4423}, {3.333, -1.2581}, {8.0, 1.0}}) {
    Scene s = hertz({208e9, 0.3, 7850.0, 0, 0, 0}, radius, 1.0, mu);
    s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
    s.sphere({0.0, 0.0, radius + 1e-11}, radius, {in * mu * vn, 0.0, -vn});
    World w = s.world();
    const Collision c = collide(w);
    const double surface = (c.velocity.x - radius * c.spin.y) / (mu * vn);
    // Our arms end at the contact point, which an overlap of 1 % of the radius shortens; the
    // reference's end at the surface.
    EXPECT_NEAR(surface, out, 0.03 * std::max(1.0, in)) << in;
  }
}

TEST(ChungOoi, test_6_a_spinning_sphere_slides_on_a_plane) {
  // pre-spin about y; surface velocity reverses by the ratio beta
  const double radius = 0.1, vn = 0.2, e = 0.5, mu = 0.4;
  for (const auto& [spin, beta] :
       {std::pair{1.0, 0.4593}, {3.0, 0.2798}, {9.0, -0.5382}, {22.0, -0.8099}}) {
    Scene s = hertz({70e9, 0.33, 2700.0, 0, 0, 0}, radius, e, mu);
    s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
    s.sphere({0.0, 0.0, radius + 1e-7}, radius, {0.0, 0.0, -vn}, {0.0, spin, 0.0});
    World w = s.world();
    const Collision c = collide(w);
    const double before = -radius * spin, after = c.velocity.x - radius * c.spin.y;
    EXPECT_NEAR(-after / before, beta, 0.05) << spin;
  }
}

TEST(ChungOoi, test_7_equal_and_opposite_spins_roll_off_without_a_tangential_force) {
  Scene s = hertz({70e9, 0.33, 2700.0, 0, 0, 0}, 0.1, 0.5, 0.4);
  s.sphere({0.0, 0.0, 0.0}, 0.1, {0.2, 0.0, 0.0}, {0.0, 5.0, 0.0});
  s.sphere({0.2000001, 0.0, 0.0}, 0.1, {-0.2, 0.0, 0.0}, {0.0, -5.0, 0.0});
  World w = s.world();
  const Collision c = collide(w);
  EXPECT_NEAR(c.velocity.z, 0.0, 1e-10);
  EXPECT_NEAR(c.spin.y, 5.0, 1e-10);
}

TEST(ChungOoi, test_7_equal_spins_meet_with_friction) {
  Scene s = hertz({70e9, 0.30, 2699.0, 0, 0, 0}, 0.1, 0.5, 0.4);
  s.sphere({0.0, 0.0, 0.0}, 0.1, {0.2, 0.0, 0.0}, {0.0, 5.0, 0.0});
  s.sphere({0.2000001, 0.0, 0.0}, 0.1, {-0.2, 0.0, 0.0}, {0.0, 5.0, 0.0});
  World w = s.world();
  const Collision c = collide(w);
  EXPECT_NEAR(std::fabs(c.velocity.z), 0.117591, 0.03 * 0.117591);
  EXPECT_NEAR(c.spin.y, 2.060216, 0.03 * 2.060216);
}

TEST(ChungOoi, test_8_a_heavy_sphere_acts_like_a_plane) {
  Scene s = hertz({70e9, 0.30, 2699.0, 0, 0, 0}, 0.1, 0.5, 0.4);
  s.sphere({0.0, 0.0, 0.0}, 0.1, {0.0, 0.0, -0.2}, {0.0, 22.0, 0.0});
  const double heavy = 1000.0 * 4.0 / 3.0 * pi * 0.125 * 2699.0;
  s.element({0.0, 0.0, -0.6000001}, 0.5, heavy, 0.4 * heavy * 0.25);
  World w = s.world();
  const Collision c = collide(w);
  const double after = c.velocity.x - 0.1 * c.spin.y;
  EXPECT_NEAR(after / 2.2, -0.8099, 0.02);
}

}  // namespace collision_test
}  // namespace breccia::dem
