// The cohesive law at one integration point: softening, fracture energy, unloading.

#include <gtest/gtest.h>

#include <random>

#include "fdem/laws/rock_failure.hpp"

namespace breccia::fdem {
namespace joint_bond_test {

constexpr double h = 1e-3;

JointBond bond(double factor = exact_softening_factor) {
  return {150e9, 3e6, 15e6, 0.7, factor * 10.0, factor * 50.0, 0.0, 0.0, 0.0, 0.0};
}
BondTraction<double> at(const JointBond& b, double opening, double slip, BondState<double>& s) {
  return response(b, 1.0, h, opening, slip, s);
}

/// Work along a straight path, by Simpson's rule.  [J/m2]
double work(const JointBond& b, Vec2 from, Vec2 to, BondState<double>& s, int steps = 2000) {
  double sum = 0.0;
  const Vec2 d = (1.0 / (2.0 * steps)) * (to - from);
  const auto power = [&](int i) {
    const Vec2 x = from + static_cast<double>(i) * d;
    const BondTraction<double> t = at(b, x.x, x.y, s);
    return t.normal * d.x + t.shear * d.y;
  };
  double before = power(0);
  for (int i = 0; i < steps; ++i) {
    const double middle = power(2 * i + 1), after = power(2 * i + 2);
    sum += (before + 4.0 * middle + after) / 3.0;
    before = after;
  }
  return sum;
}

TEST(JointBond, softens_as_the_table_says) {
  const double table[] = {1.0,        .87831658,  .678410777, .509572205, .389044591, .304138074,
                          .238162909, .179111943, .120773541, .061081323, 0.0};
  for (int i = 0; i <= 10; ++i) EXPECT_NEAR(softening(0.1 * i), table[i], 6e-10) << i;
  EXPECT_EQ(softening(1.0), 0.0);
  EXPECT_EQ(softening(0.0), 1.0);  // the ledger of whole joints relies on it
  double integral = 0.0, last = 1.0;
  constexpr int n = 1000;
  for (int i = 0; i < n; ++i) {
    const double d = 1.0 / n, a = i * d;
    integral += d / 6.0 * (softening(a) + 4.0 * softening(a + 0.5 * d) + softening(a + d));
    EXPECT_LT(softening(a + d), last);
    last = softening(a + d);
  }
  EXPECT_NEAR(integral, 0.386307294745, 1e-11);
  EXPECT_NEAR(integral * exact_softening_factor, 1.0, 1e-8);
}

TEST(JointBond, decay_is_the_exponential) {
  for (double t = 0.0; t <= 4.0; t += 1.0 / 64.0) EXPECT_NEAR(decay(t), std::exp(-t), 1e-15);
}

TEST(JointBond, pressed_keeps_its_residual_friction_while_it_softens) {
  JointBond b = bond();
  b.residual = 0.5;
  const double pressure = 10e6, opening = -pressure * h / b.stiffness;
  const double peak = 15e6 + 0.7 * pressure, s_p = 2.0 * h * peak / b.stiffness;
  const double s_t = b.softening_slide / peak;
  BondState<double> s{};
  EXPECT_NEAR(at(b, opening, s_p, s).shear, peak, 1e-6 * peak);
  for (const double damage : {0.25, 0.5, 0.75, 1.0}) {
    const double z = softening(damage);
    EXPECT_NEAR(at(b, opening, s_p + damage * s_t, s).shear, z * peak + (1.0 - z) * 0.5 * pressure,
                1e-6 * peak);
  }
  // Pulled apart there is nothing left to rub, and on the way back it unloads along the secant.
  EXPECT_EQ(at(b, 1e-9, s_p + s_t, s).shear, 0.0);
  EXPECT_NEAR(at(b, opening, 0.5 * (s_p + s_t), s).shear, 0.25 * pressure, 1e-6 * peak);
  // Work beyond that of friction is the share of its fracture energy that friction leaves.
  BondState<double> fresh{};
  const double whole = work(b, {opening, s_p}, {opening, s_p + s_t}, fresh);
  EXPECT_NEAR(whole - 0.5 * pressure * s_t, (peak - 0.5 * pressure) / peak * 50.0, 1e-4);
}

/// What residual friction bears is what a joint without it would lack, wherever it goes; what it
/// stores likewise.
TEST(JointBond, tells_what_of_its_traction_is_residual_friction) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  for (const double reversible : {0.0, 1.0}) {
    JointBond rough = bond(), smooth = bond();
    rough.reversible = smooth.reversible = reversible;
    rough.residual = 0.5;
    double most = 0.0;
    for (int path = 0; path < 20; ++path) {
      BondState<double> one{}, other{};
      double opening = 0.0, slip = 0.0;
      for (int i = 0; i < 200; ++i) {
        opening += 1e-8 * part(random);
        slip += 3e-7 * part(random);
        const double rubs =
            at(rough, opening, slip, one).shear - at(smooth, opening, slip, other).shear;
        EXPECT_NEAR(residual_traction(rough, 1.0, h, opening, slip, one), rubs, 1.0);
        const double held = stored(rough, 1.0, h, opening, slip, one).slide -
                            stored(smooth, 1.0, h, opening, slip, other).slide;
        EXPECT_NEAR(stored(rough, 1.0, h, opening, slip, one).rubs, held, 1e-9);
        most = std::max(most, std::abs(rubs));
      }
    }
    EXPECT_GT(most, 1e5);
  }
}

TEST(JointBond, opened_until_it_breaks_takes_its_fracture_energy_and_the_elastic_part) {
  for (const auto& [factor, expected] :
       {std::pair{3.0, 0.080 + 3.0 * 10.0 * 0.386307294745}, {exact_softening_factor, 10.080}}) {
    const JointBond b = bond(factor);
    BondState<double> s{};
    const double elastic = 4e-8, whole = elastic + factor * 10.0 / 3e6;
    const double spent =
        work(b, {0.0, 0.0}, {elastic, 0.0}, s) + work(b, {elastic, 0.0}, {whole, 0.0}, s);
    EXPECT_NEAR(spent, expected, 1e-6 * expected);
    EXPECT_EQ(at(b, 1.001 * whole, 0.0, s).normal, 0.0);
    EXPECT_EQ(s.damage, 1.0);
  }
  EXPECT_NEAR(0.080 + 3.0 * 10.0 * 0.386307294745, 11.669, 5e-4);
}

TEST(JointBond, slid_until_it_breaks_takes_its_other_fracture_energy) {
  for (const double side : {1.0, -1.0}) {
    const JointBond b = bond();
    BondState<double> s{};
    const double elastic = 2.0 * h * 15e6 / 150e9;
    const double whole = elastic + exact_softening_factor * 50.0 / 15e6;
    const double spent = work(b, {0.0, 0.0}, {0.0, side * elastic}, s) +
                         work(b, {0.0, side * elastic}, {0.0, side * whole}, s);
    EXPECT_NEAR(spent, 2.0 / 3.0 * 15e6 * elastic + 50.0, 1e-6);
    EXPECT_NEAR(s.damage, 1.0, 1e-14);
  }
}

TEST(JointBond, strength_scales_stress_and_energy_alike) {
  BondState<double> one{}, two{};
  for (const double x : {1e-8, 1e-6, 4e-6}) {
    const JointBond b = bond();
    JointBond stiff = b;
    stiff.stiffness *= 2.0;  // so that the elastic limits stay
    const BondTraction<double> t = response(b, 1.0, h, x, 2.0 * x, one);
    const BondTraction<double> u = response(stiff, 2.0, h, x, 2.0 * x, two);
    EXPECT_NEAR(u.normal, 2.0 * t.normal, 1e-9 * t.normal);
    EXPECT_NEAR(u.shear, 2.0 * t.shear, 1e-9 * t.shear);
  }
}

TEST(JointBond, is_a_linear_spring_in_compression_whatever_its_damage) {
  const JointBond b = bond();
  BondState<double> s{};
  EXPECT_NEAR(at(b, -1e-8, 0.0, s).normal, -1.5e6, 1e-6);
  at(b, 5e-6, 0.0, s);
  EXPECT_GT(s.damage, 0.1);
  EXPECT_NEAR(at(b, -1e-7, 0.0, s).normal, -15e6, 1e-5);
}

TEST(JointBond, shear_strength_grows_with_pressure) {
  const JointBond b = bond();
  for (const double pressure : {0.0, 5e6, 20e6}) {
    BondState<double> s{};
    const double strength = 15e6 + 0.7 * pressure, limit = 2.0 * h * strength / 150e9;
    const double opening = -pressure * h / 150e9;
    EXPECT_NEAR(at(b, opening, limit, s).shear, strength, 1e-9 * strength);
    EXPECT_LT(s.damage, 1e-14);
    BondState<double> back{};
    EXPECT_NEAR(at(b, opening, -0.5 * limit, back).shear, -0.75 * strength, 1e-9 * strength);
  }
}

TEST(JointBond, unloads_on_the_secant_and_comes_back_to_the_curve) {
  const JointBond b = bond();
  BondState<double> s{};
  const double top = at(b, 3e-6, 0.0, s).normal;
  const double kept = s.damage;
  EXPECT_GT(kept, 0.3);
  EXPECT_NEAR(at(b, 1.5e-6, 0.0, s).normal, 0.5 * top, 1e-6);
  EXPECT_EQ(at(b, 0.0, 0.0, s).normal, 0.0);
  EXPECT_EQ(at(b, 3e-6, 0.0, s).normal, top);
  EXPECT_EQ(s.damage, kept);
  BondState<double> straight{};
  EXPECT_NEAR(at(b, 5e-6, 0.0, s).normal, at(b, 5e-6, 0.0, straight).normal, 1e-6);
}

TEST(JointBond, heals_only_where_it_is_told_to) {
  JointBond b = bond();
  b.reversible = 1.0;
  BondState<double> fresh{}, used{};
  const double peak = at(b, 4e-8, 0.0, fresh).normal;
  at(b, 5e-6, 0.0, used);
  EXPECT_EQ(at(b, 4e-8, 0.0, used).normal, peak);
}

/// Random closed paths in tension: the first round dissipates, and once damage grows no more, a
/// round takes and gives nothing.
TEST(JointBond, closed_paths_never_make_energy) {
  const JointBond b = bond();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> opening(0.0, 6e-6), slip(-6e-6, 6e-6);
  for (int path = 0; path < 100; ++path) {
    Vec2 corner[6];
    for (int i = 1; i < 6; ++i) corner[i] = {opening(random), slip(random)};
    BondState<double> s{};
    double round[3] = {};
    for (double& r : round)
      for (int i = 0; i < 6; ++i) r += work(b, corner[i], corner[(i + 1) % 6], s, 500);
    EXPECT_GT(round[0], 0.01 * 10.0) << path;
    EXPECT_GE(round[1], -1e-6 * 10.0) << path;
    // Simpson's rule meets a kink where the slip changes its sign
    EXPECT_NEAR(round[2], 0.0, 1e-5 * 10.0) << path;
  }
}

/// The energy that the law says is stored comes back on the way to zero.
TEST(JointBond, stored_energy_is_what_unloading_gives_back) {
  const JointBond b = bond();
  for (const Vec2& x : {Vec2{2e-8, 3e-8}, Vec2{3e-6, 1e-7}, Vec2{1e-6, -4e-6}, Vec2{2e-8, 2e-6}}) {
    BondState<double> s{};
    work(b, {0.0, 0.0}, x, s);
    const StoredEnergy e = stored(b, 1.0, h, x.x, x.y, s);
    EXPECT_NEAR(work(b, x, {0.0, 0.0}, s), -(e.open + e.slide), 1e-9 * 10.0);
  }
}

}  // namespace joint_bond_test
}  // namespace breccia::fdem
