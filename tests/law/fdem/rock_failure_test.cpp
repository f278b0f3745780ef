// Joints that fail with the rock: the criterion by angle, the energy of inclined edges, no jump.

#include "fdem/laws/rock_failure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fdem/joints/joints.hpp"

namespace breccia::fdem {
namespace rock_failure_test {

constexpr double h = 1e-3, tension = 3e6, cohesion = 15e6, energy = 10.0, phi = 0.7;
constexpr double degree = 3.14159265358979323846 / 180.0;

/// c = 5 f_t, G_II = 5 G_I.
JointBond bond(double tan_phi = phi) {
  return {3e12,
          tension,
          cohesion,
          tan_phi,
          exact_softening_factor * energy,
          exact_softening_factor * 5.0 * energy,
          0.0,
          0.0,
          30e9,
          0.2};
}
/// sigma_1 and sigma_2 as an edge sees them whose normal is turned by an angle from sigma_1.
RockStress rotated(double first, double second, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {first * c * c + second * s * s, (second - first) * s * c, first * s * s + second * c * c};
}

/// One edge, theta off the plane of largest tension, drawn apart along the tension until it breaks.
struct Drawn {
  double peak = 0.0, spent = 0.0;  ///< over f_t, and over G_I, by projected length  [-]

  Drawn(double theta, const Vec2& from, BondState<double> s) {
    const double c = std::cos(theta), n = std::sin(theta), step = 2e-10;
    const auto pull = [&](double d) {
      const BondTraction<double> t = response(bond(), 1.0, h, from.x + d * c, from.y + d * n, s);
      return (t.normal * c + t.shear * n) / c;
    };
    double last = pull(0.0);
    for (int i = 1; s.damage < 1.0; ++i) {
      const double now = pull(i * step);
      peak = std::max({peak, last / tension, now / tension});
      spent += 0.5 * (last + now) * step / energy;
      last = now;
    }
  }
};

/// By its own tractions an inclined edge bears f_t and c, and takes
/// G_I (1 + (c/f_t) tan theta)/|(cos theta, (o_t/s_t) sin theta)| by projected length; here
/// o_t = s_t.
TEST(RockFailure, by_its_own_tractions_an_inclined_edge_takes_more_the_more_it_is_inclined) {
  for (const double angle : {0.0, 10.0, 20.0, 30.0, 45.0}) {
    const Drawn edge(angle * degree, {}, {});
    const double expected = 1.0 + cohesion / tension * std::tan(angle * degree);
    std::printf("edge, %2.0f degrees: peak %.4f f_t, energy %.4f G_I (formula %.4f)\n", angle,
                edge.peak, edge.spent, expected);
    EXPECT_NEAR(edge.spent, expected, 0.005 * expected);
    EXPECT_NEAR(edge.peak, expected, 0.005 * expected);
  }
}

/// The rock pulled until it fails there, then drawn apart: f_t and G_I, by projected length,
/// whatever theta; from 35 degrees on more by cos^2 35/cos^2 theta.
TEST(RockFailure, with_the_rock_an_inclined_edge_has_f_t_and_takes_g_i) {
  for (const double angle : {0.0, 10.0, 20.0, 30.0, 45.0}) {
    const double theta = angle * degree, cos2 = std::pow(std::cos(theta), 2);
    const double expected = std::max(1.0, std::pow(std::cos(35.0 * degree), 2) / cos2);
    const auto rock = [&](double share) {
      return rotated(share * expected * tension, 0.0, -theta);
    };
    const RockStress below = rock(1.0 - 1e-9);
    EXPECT_EQ(failure_of(rock_failure(bond(), 1.0, below)), Failure::none) << angle;
    EXPECT_EQ(failure_of(rock_failure(bond(), 1.0, rock(1.0 + 1e-9))), Failure::torn) << angle;
    Vec2 at;
    ASSERT_TRUE(preset_opening(bond(), 1.0, h, below.normal, below.shear, at));
    BondState<double> s{};
    fail(bond(), 1.0, h, Failure::torn, at.x, at.y, {below.normal, below.shear}, s);
    const Drawn drawn(theta, at, s);
    std::printf("rock, %2.0f degrees: peak %.4f f_t, energy %.4f G_I (expected %.4f)\n", angle,
                drawn.peak, drawn.spent, expected);
    EXPECT_NEAR(drawn.peak, expected, 1e-6);
    EXPECT_NEAR(drawn.spent, expected, 1e-4);
  }
}

TEST(RockFailure, rankine_counts_within_35_degrees_and_fades_until_60) {
  const auto torn = [](double angle) {
    return rock_failure(bond(), 1.0, rotated(tension, 0.0, angle * degree)).torn;
  };
  const auto cos2 = [](double angle) { return std::pow(std::cos(angle * degree), 2); };
  for (const double angle : {0.0, 20.0, 34.9, -34.9}) EXPECT_NEAR(torn(angle), 1.0, 1e-12) << angle;
  for (const double angle : {35.1, 50.0, 59.9, -59.9})
    EXPECT_NEAR(torn(angle), cos2(angle) / cos2(35.0), 1e-12) << angle;
  for (const double angle : {60.1, 75.0, 90.0}) EXPECT_NEAR(torn(angle), cos2(angle), 1e-12);
  // An edge that is pressed does not tear.
  EXPECT_LE(rock_failure(bond(), 1.0, rotated(tension, -3.0 * tension, 50.0 * degree)).torn, 0.0);
  // Strength of the joint scales its law's.
  EXPECT_NEAR(rock_failure(bond(), 2.0, rotated(tension, 0.0, 0.1)).torn, 0.5, 1e-12);
}

/// Uniaxial compression slides on planes whose normals are 45 + phi/2 degrees from the load.
TEST(RockFailure, mohr_and_coulomb_count_within_25_degrees_of_a_plane_that_slides) {
  const double friction_angle = std::atan(phi);
  const double strength =
      2.0 * cohesion * std::cos(friction_angle) / (1.0 - std::sin(friction_angle));
  const double plane = 45.0 + 0.5 * friction_angle / degree;
  const auto sheared = [&](double angle) {  // of the edge's normal to the load
    return rock_failure(bond(), 1.0, rotated(-strength, 0.0, angle * degree)).sheared;
  };
  for (const double off : {0.0, 24.9, -24.9}) {
    EXPECT_NEAR(sheared(plane + off), 1.0, 1e-12) << off;
    EXPECT_NEAR(sheared(-plane - off), 1.0, 1e-12) << off;
  }
  for (const double off : {25.1, -25.1}) {
    EXPECT_EQ(sheared(plane + off), 0.0) << off;
    EXPECT_EQ(sheared(-plane - off), 0.0) << off;
  }
  EXPECT_EQ(sheared(0.0), 0.0);
}

TEST(RockFailure, never_comes_where_the_quick_look_sees_none) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> stress(-30e6, 6e6);
  int failed = 0, passed_over = 0;
  for (int i = 0; i < 20000; ++i) {
    const RockStress s{stress(random), stress(random), stress(random)};
    const bool fails = failure_of(rock_failure(bond(), 1.0, s)) != Failure::none;
    const bool may = may_fail(tension, cohesion, phi, s.normal, s.shear, s.along);
    EXPECT_TRUE(may || !fails);
    failed += fails ? 1 : 0;
    passed_over += may ? 0 : 1;
  }
  EXPECT_GT(failed, 1000);
  EXPECT_GT(passed_over, 1000);
}

/// sigma_l of a plate that is strained: plane stress, sigma = E/(1 - nu^2) (eps + nu eps').
TEST(RockFailure, stress_along_an_edge_follows_from_its_stretch) {
  const double young = 30e9, poisson = 0.2, along = 2e-4, across = -1e-4;
  const double factor = young / (1.0 - poisson * poisson);
  const double normal = factor * (across + poisson * along);
  const double expected = factor * (along + poisson * across);
  const Sym2 none{}, in_situ{-3e6, -1e6, 0.5e6};
  const Vec2 axis{0.6, 0.8};
  EXPECT_NEAR(stress_along(axis, along, normal, 0.0, young, poisson, 0.0, none), expected,
              1e-6 * expected);
  // Stress in situ alone: the edge is not stretched, its joint carries S_0 n.
  const auto of = [&](const Vec2& n, const Vec2& m) { return dot(in_situ * n, m); };
  const Vec2 normal_axis{-axis.y, axis.x};
  const double at_start = of(normal_axis, normal_axis);
  EXPECT_NEAR(stress_along(axis, 0.0, at_start, 0.0, young, poisson, 0.0, in_situ), of(axis, axis),
              1e-3);
}

/// Of points drawn at random, fresh and half soft ones, drawn and pressed ones.
TEST(RockFailure, no_force_jumps_when_a_point_fails) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  JointBond b = bond();
  b.residual = 0.3;
  const double o_p = 2.0 * h * tension / b.stiffness, s_p = 2.0 * h * cohesion / b.stiffness;
  int torn = 0, sheared = 0, soft = 0;
  for (int i = 0; i < 4000; ++i) {
    const bool drawn = i % 2 == 0;
    BondState<double> s{};
    if (i % 4 >= 2) response(b, 1.0, h, 3e-6 * unit(random), 3e-6 * unit(random), s);
    const double opening = (drawn ? 2.0 : -4.0) * o_p * unit(random);
    const double slip = 3.0 * s_p * (unit(random) - 0.5);
    const BondTraction<double> before = response(b, 1.0, h, opening, slip, s);
    soft += s.damage > 0.0 ? 1 : 0;
    const Failure how = i % 8 < 4 ? Failure::torn : Failure::sheared;
    // Drawn and torn ones keep a hundredth of f_t at least.
    if (drawn && before.normal < 0.01 * tension * softening(s.damage)) continue;
    fail(b, 1.0, h, how, opening, slip, before, s);
    EXPECT_EQ(failure_of(s), how);
    const BondTraction<double> after = response(b, 1.0, h, opening, slip, s);
    EXPECT_NEAR(after.normal, before.normal, 1e-6 * tension) << i;
    EXPECT_NEAR(after.shear, before.shear, 1e-6 * cohesion) << i;
    torn += how == Failure::torn ? 1 : 0;
    sheared += how == Failure::sheared ? 1 : 0;
  }
  EXPECT_GT(torn, 500);
  EXPECT_GT(sheared, 500);
  EXPECT_GT(soft, 500);
}

/// The vector fades over o_t: |t_0| G_I/f_t, which is G_I by projected length if |t_0| = f_t cos.
TEST(RockFailure, torn_edge_takes_g_i_by_projected_length_and_unloads_along_the_secant) {
  for (const double angle : {0.0, 15.0, 30.0}) {
    const JointBond b = bond();
    const double c = std::cos(angle * degree), n = std::sin(angle * degree);
    const double o_t = b.softening_open / b.tension, start = 1e-9;
    const BondTraction<double> carried{tension * c * c, tension * c * n};
    BondState<double> s{};
    fail(b, 1.0, h, Failure::torn, start * c, start * n, carried, s);
    const int steps = 20000;
    double spent = 0.0;
    for (int i = 0; i < steps; ++i) {
      const double d = start + (i + 0.5) * o_t / steps;
      const BondTraction<double> t = response(b, 1.0, h, d * c, d * n, s);
      spent += (t.normal * c + t.shear * n) * o_t / steps;
      if (i != steps / 2) continue;
      BondState<double> back = s;
      EXPECT_NEAR(response(b, 1.0, h, 0.5 * d * c, 0.5 * d * n, back).normal, 0.5 * t.normal, 1.0);
      EXPECT_EQ(back.damage, s.damage);
      const StoredEnergy held = stored(b, 1.0, h, d * c, d * n, s);
      EXPECT_NEAR(held.open + held.slide, 0.5 * d * (t.normal * c + t.shear * n), 1e-12);
    }
    EXPECT_NEAR(spent, energy * c, 1e-4 * energy);
    response(b, 1.0, h, (start + o_t) * c, (start + o_t) * n, s);
    EXPECT_NEAR(s.damage, 1.0, 1e-12);
  }
}

/// A failed edge that closes: pressed where it is slid and eased where it goes back, over and over,
/// it must not give what nobody put in. Random paths, pressed and drawn, from a point torn at the
/// origin or sheared under pressure: what has come out never exceeds what went in and was stored.
TEST(RockFailure, failed_edge_never_gives_energy) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> opening(-2e-8, 1e-8), slip(-1e-6, 1e-6);
  JointBond b = bond();
  for (const Failure how : {Failure::torn, Failure::sheared})
    for (const double residual : {0.0, 0.5}) {
      b.residual = residual;
      double least = 0.0, spent = 0.0;
      for (int path = 0; path < 50; ++path) {
        BondState<double> s{};
        Vec2 at{};
        BondTraction<double> carried{0.5 * tension, 0.0};
        if (how == Failure::sheared) {
          at = {-1e-8, 1.5e-8};
          carried = response(b, 1.0, h, at.x, at.y, s);
        }
        fail(b, 1.0, h, how, at.x, at.y, carried, s);
        BondTraction<double> t = response(b, 1.0, h, at.x, at.y, s);
        const StoredEnergy held = stored(b, 1.0, h, at.x, at.y, s);
        double sum = how == Failure::sheared ? held.open + held.slide : 0.0;
        for (int leg = 0; leg < 40; ++leg) {
          // pressed, slid, eased, back: the pump; every other path goes anywhere
          const double p = -2e-8, a = 1e-6;
          const Vec2 pump[4] = {{p, a}, {p, 0.0}, {0.0, 0.0}, {0.0, a}};
          const Vec2 to = path % 2 == 0 ? pump[leg % 4] : Vec2{opening(random), slip(random)};
          const int steps = 400;
          const Vec2 d = (1.0 / steps) * (to - at);
          for (int i = 1; i <= steps; ++i) {
            const Vec2 x = at + static_cast<double>(i) * d;
            const BondTraction<double> next = response(b, 1.0, h, x.x, x.y, s);
            sum += 0.5 * ((t.normal + next.normal) * d.x + (t.shear + next.shear) * d.y);
            least = std::min(least, sum);
            t = next;
          }
          at = to;
        }
        spent += sum / 50.0;
      }
      EXPECT_GT(least, -1e-3 * energy) << static_cast<int>(how) << ' ' << residual;
      EXPECT_GT(spent, energy) << static_cast<int>(how) << ' ' << residual;
    }
}

/// Sheared under pressure: what it bears over residual friction is the share of G_II.
TEST(RockFailure, sheared_edge_takes_g_ii_and_keeps_its_residual_friction) {
  for (const double residual : {0.0, 0.5}) {
    JointBond b = bond();
    b.residual = residual;
    const double pressure = 10e6, opening = -pressure * h / b.stiffness;
    BondState<double> s{};
    const double slip = 0.6 * 2.0 * h * cohesion / b.stiffness;
    const BondTraction<double> carried = response(b, 1.0, h, opening, slip, s);
    fail(b, 1.0, h, Failure::sheared, opening, slip, carried, s);
    const double s_t = b.softening_slide / carried.shear;
    const int steps = 20000;
    double over_friction = 0.0;
    for (int i = 0; i < steps; ++i) {
      const double at = slip + (i + 0.5) * s_t / steps;
      const BondTraction<double> t = response(b, 1.0, h, opening, at, s);
      over_friction += (t.shear - residual * pressure) * s_t / steps;
      EXPECT_EQ(t.normal, carried.normal);
    }
    const double share = (carried.shear - residual * pressure) / carried.shear;
    EXPECT_NEAR(over_friction, share * 5.0 * energy, 1e-3 * energy);
    EXPECT_NEAR(response(b, 1.0, h, opening, slip + s_t, s).shear, residual * pressure, 1e-3);
    EXPECT_NEAR(s.damage, 1.0, 1e-12);
  }
}

/// Contact takes over what a pressed point holds, whole, softened or failed, and nothing of one
/// that is open.
TEST(RockFailure, only_pressed_points_hold_what_contact_can_take) {
  const JointBond b = bond();
  for (const Failure how : {Failure::none, Failure::torn, Failure::sheared})
    for (const double opening : {-2e-7, 2e-7}) {
      BondState<double> s{};
      const double slip = 3e-7;
      const BondTraction<double> carried = response(b, 1.0, h, opening, slip, s);
      if (how != Failure::none) fail(b, 1.0, h, how, opening, slip, carried, s);
      const StoredEnergy all = stored(b, 1.0, h, opening, slip, s);
      const StoredEnergy taken = stored_pressed(b, 1.0, h, opening, slip, s);
      EXPECT_GT(all.open, 0.0);
      EXPECT_GT(all.slide, 0.0);
      EXPECT_EQ(taken.open, opening < 0.0 ? all.open : 0.0);
      EXPECT_EQ(taken.slide, opening < 0.0 ? all.slide : 0.0);
    }
}

}  // namespace rock_failure_test
}  // namespace breccia::fdem
