// Failure of the rock at a joint in space: principal stresses, the criterion by angle against that
// of the plane, the cheap question before it, and the stress in the face.

#include "fdem3/laws/rock_failure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace breccia::fdem3 {
namespace rock_failure_test {

constexpr double tension = 3e6, cohesion = 15e6, phi = 0.7;
constexpr double degree = 3.14159265358979323846 / 180.0;

JointBond bond() {
  return {6e11, tension, cohesion, phi, 26.0, 130.0, 0.0, 0.0, 30e9, 0.2};
}
Vec3 unit(double a, double b, double c) {
  const double size = std::sqrt(a * a + b * b + c * c);
  return {a / size, b / size, c / size};
}
/// sum of value_k axis_k (x) axis_k
Sym3 composed(const double (&value)[3], const Vec3 (&axis)[3]) {
  Sym3 s{};
  for (int k = 0; k < 3; ++k) {
    const Vec3& e = axis[k];
    s.xx += value[k] * e.x * e.x;
    s.yy += value[k] * e.y * e.y;
    s.zz += value[k] * e.z * e.z;
    s.yz += value[k] * e.y * e.z;
    s.xz += value[k] * e.x * e.z;
    s.xy += value[k] * e.x * e.y;
  }
  return s;
}
/// Any three orthogonal axes.
struct Axes {
  Vec3 axis[3];
  explicit Axes(std::mt19937& random) {
    std::normal_distribution<double> any;
    axis[0] = unit(any(random), any(random), any(random));
    const Vec3 other = unit(any(random), any(random), any(random));
    const Vec3 across = cross(axis[0], other);
    axis[1] = unit(across.x, across.y, across.z);
    axis[2] = cross(axis[0], axis[1]);
  }
};

TEST(RockFailureInSpace, principal_stresses_are_those_that_a_stress_was_made_of) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const Axes axes(random);
    double value[3] = {number(random), number(random), number(random)};
    if (i % 4 == 0) value[1] = value[0];  // two alike
    const Principal p = principal(composed(value, axes.axis));
    std::sort(value, value + 3, std::greater<>());
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(p.value[k], value[k], 1e-14);
    const Sym3 back = composed(p.value, p.axis), s = composed(value, p.axis);
    EXPECT_NEAR(back.xz, s.xz, 1e-14);
    EXPECT_NEAR(dot(p.axis[0], p.axis[1]), 0.0, 1e-14);
  }
}

TEST(RockFailureInSpace, the_largest_stress_is_above_a_number_or_not) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const Axes axes(random);
    const double value[3] = {number(random), number(random), number(random)};
    const double most = std::max({value[0], value[1], value[2]});
    const Sym3 s = composed(value, axes.axis);
    EXPECT_TRUE(exceeds(s, most - 1e-9));
    EXPECT_FALSE(exceeds(s, most + 1e-9));
  }
}

/// Where sigma_2 is the stress in the face across the plane of the other two, both methods ask
/// alike.
TEST(RockFailureInSpace, in_a_plane_it_is_the_criterion_of_the_plane_method) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> stress(-150e6, 6e6), turn(0.0, 90.0);
  int torn = 0, sheared = 0, differ = 0;
  for (int i = 0; i < 20000; ++i) {
    double first = stress(random), third = stress(random);
    if (first < third) std::swap(first, third);
    const double angle = turn(random) * degree, c = std::cos(angle), n = std::sin(angle);
    const fdem::RockStress plane{first * c * c + third * n * n, (third - first) * n * c,
                                 first * n * n + third * c * c};
    RockStress space{};
    space.s.zz = plane.normal;
    space.s.xz = plane.shear;
    space.s.xx = plane.along;
    space.s.yy = 0.5 * (first + third);
    const fdem::RockFailure p = fdem::rock_failure(bond(), 1.0, plane);
    const fdem::RockFailure s = rock_failure(bond(), 1.0, space);
    EXPECT_NEAR(s.torn, p.torn, 1e-9 * (1.0 + std::abs(p.torn)));
    if ((s.sheared > 0.0) != (p.sheared > 0.0))
      ++differ;  // whether a face is near enough to slide is a yes or no: rounding at its border
    else
      EXPECT_NEAR(s.sheared, p.sheared, 1e-9 * (1.0 + p.sheared));
    torn += s.torn >= 1.0 ? 1 : 0;
    sheared += s.sheared >= 1.0 ? 1 : 0;
  }
  EXPECT_LE(differ, 2);
  EXPECT_GT(torn, 100);
  EXPECT_GT(sheared, 100);
}

/// Pulled along any direction within 35 degrees of its normal a joint fails at f_t, whatever lies
/// across; at 50 degrees at f_t cos^2 35/cos^2 50.
TEST(RockFailureInSpace, a_face_is_torn_where_the_rock_reaches_its_strength) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> turn(0.0, 360.0);
  for (const double theta : {0.0, 10.0, 20.0, 34.9, 50.0}) {
    const double around = turn(random) * degree, t = theta * degree;
    const Vec3 pull{std::sin(t) * std::cos(around), std::sin(t) * std::sin(around), std::cos(t)};
    const Vec3 side = theta > 0.0 ? unit(-pull.y, pull.x, 0.0) : Vec3{1.0, 0.0, 0.0};
    const Vec3 axis[3] = {pull, side, cross(pull, side)};
    const double value[3] = {tension, 0.0, 0.0};
    const double expected =
        theta < 35.0 ? 1.0 : std::pow(std::cos(t) / std::cos(35.0 * degree), 2.0);
    EXPECT_NEAR(rock_failure(bond(), 1.0, {composed(value, axis)}).torn, expected, 1e-12) << theta;
  }
}

TEST(RockFailureInSpace, the_cheap_question_misses_no_failure) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> stress(-60e6, 5e6);
  int failed = 0, asked = 0;
  for (int i = 0; i < 50000; ++i) {
    const Axes axes(random);
    const double value[3] = {stress(random), stress(random), stress(random)};
    const RockStress s{composed(value, axes.axis)};
    const bool fails = rock_failure(bond(), 1.0, s).most() >= 1.0,
               may = may_fail(bond().tension, bond().cohesion, bond().friction, s);
    EXPECT_TRUE(may || !fails);
    failed += fails ? 1 : 0;
    asked += may ? 1 : 0;
  }
  EXPECT_GT(failed, 1000);
  EXPECT_LT(asked, 50000);
}

/// A body under one strain: the stress in a face whatever its place, from Hooke's law in space.
TEST(RockFailureInSpace, the_stress_in_the_face_is_that_of_the_body) {
  std::mt19937 random(6);
  const double young = 30e9, poisson = 0.2, lambda = young * poisson / (1.2 * 0.6),
               mu = young / 2.4;
  const Sym3 strain{3e-6, -2e-6, 5e-6, 1e-6, -4e-6, 2e-6};
  const double sum = trace(strain);
  const auto hooke = [&](double normal, double own) { return lambda * normal + 2.0 * mu * own; };
  const Sym3 body{hooke(sum, strain.xx), hooke(sum, strain.yy), hooke(sum, strain.zz),
                  2.0 * mu * strain.yz,  2.0 * mu * strain.xz,  2.0 * mu * strain.xy};
  for (int i = 0; i < 100; ++i) {
    const Axes f(random);
    const Vec3 start[3] = {{}, 1e-3 * f.axis[0], 3e-4 * f.axis[0] + 8e-4 * f.axis[1]};
    Vec3 now[3];
    for (int k = 0; k < 3; ++k) now[k] = start[k] + strain * start[k];
    const JointOpening o = opening_of(now, now);
    const Vec3 traction = body * o.normal;
    const RockStress r =
        rock_stress(bond().young, bond().poisson, FaceShape::of(start[0], start[1], start[2]), o,
                    traction, Sym3{});
    const Vec3 across = cross(o.normal, o.along);
    const double within = 1e-4 * 3e5;  // strains are small, not none
    EXPECT_NEAR(r.s.xx, dot(o.along, body * o.along), within);
    EXPECT_NEAR(r.s.yy, dot(across, body * across), within);
    EXPECT_NEAR(r.s.xy, dot(o.along, body * across), within);
    EXPECT_NEAR(r.s.zz, dot(o.normal, traction), within);
    EXPECT_NEAR(r.s.xz, dot(o.along, traction), within);
  }
}

}  // namespace rock_failure_test
}  // namespace breccia::fdem3
