// The parallel bond against closed answers.

#include "dem/laws/parallel_bond.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pair_driver.hpp"

namespace breccia::dem {
namespace parallel_bond_test {

using testing::Pair;

constexpr double length = 0.02, radius = 0.008, modulus = 40e9;
const double area = pi * radius * radius;
const ParallelBond bond{10e6, 25e6, 0.5, 0.4, 0.4, 1.0, 1.0};
const ParallelBond::Constants k{length, modulus* area / length, radius, 0.02, 1.0};

/// Work that the ends do on the bond in one step, by the trapezoidal rule.
class Driver {
 public:
  explicit Driver(const ParallelBond& law) : law_(law) {}

  ParallelBondResponseOf<double> move(const Vec3& velocity, const Vec3& spin = {}) {
    const PairMotion<double> m = pair_.move_b(velocity, spin);
    const ParallelBondResponseOf<double> r = law_.response(k, m, state_);
    work_ += 0.5 * (last_.normal + r.normal) * m.extension -
             0.5 * dot(last_.shear + r.shear, m.slip) - 0.5 * dot(last_.moment + r.moment, m.turn);
    spent_ += r.slid + r.broke;
    slid_ += r.slid;
    last_ = r;
    normal_ = m.normal;
    return r;
  }
  double missing() const {
    const double stretch = norm(pair_.b.position - pair_.a.position) - length;
    return work_ - spent_ - law_.stored(k, normal_, stretch, state_);
  }
  double work() const { return work_; }
  double slid() const { return slid_; }
  const ParallelBondState& state() const { return state_; }
  double dt() const { return pair_.dt; }

 private:
  ParallelBond law_;
  Pair pair_;
  ParallelBondState state_{1.0, 0.0, {}, {}};
  ParallelBondResponseOf<double> last_{};
  Vec3 normal_{1.0, 0.0, 0.0};
  double work_ = 0.0, spent_ = 0.0, slid_ = 0.0;
};

TEST(ParallelBond, in_pure_tension_it_bears_its_strength_times_its_area_and_then_nothing) {
  Driver d(bond);
  const double rate = 1e-4 * bond.tensile_strength / modulus * length / d.dt();
  double most = 0.0;
  for (int i = 0; i < 10'100; ++i) most = std::max(most, d.move({rate, 0.0, 0.0}).normal);
  EXPECT_NEAR(most, bond.tensile_strength * area, 2e-4 * bond.tensile_strength * area);
  EXPECT_EQ(d.state().bond, 0.0);
  EXPECT_EQ(d.move({rate, 0.0, 0.0}).normal, 0.0);
  EXPECT_NEAR(d.state().strained, 1.0, 2e-4);
  EXPECT_LT(std::fabs(d.missing()), 1e-9 * d.work());
}

TEST(ParallelBond, bending_breaks_it_at_the_moment_of_a_disc_section) {
  // sigma = M R / I, I = pi R^4 / 4
  Driver d(bond);
  const double largest = bond.tensile_strength * pi * radius * radius * radius / 4.0;
  const double rate = 1e-4 * largest / k.bending() / d.dt();
  double most = 0.0;
  for (int i = 0; i < 10'100; ++i) {
    most = std::max(most, norm(d.move({}, {0.0, 0.0, rate}).moment));
  }
  EXPECT_EQ(d.state().bond, 0.0);
  EXPECT_NEAR(most, largest, 1e-3 * largest);
  EXPECT_LT(std::fabs(d.missing()), 1e-6 * d.work());
}

TEST(ParallelBond, under_pressure_it_shears_at_cohesion_plus_friction_and_then_slides) {
  Driver d(bond);
  const double pressure = 20e6;
  for (int i = 0; i < 1'000; ++i) d.move({-pressure / modulus * length / 1'000 / d.dt(), 0.0, 0.0});
  const double bears = bond.cohesion + bond.friction * pressure;
  const double rate = 1e-4 * bears * area / (bond.shear_ratio * k.stiffness) / d.dt();
  double most = 0.0, last = 0.0;
  for (int i = 0; i < 14'000; ++i) {
    last = norm(d.move({0.0, rate, 0.0}).shear);
    most = std::max(most, last);
  }
  EXPECT_NEAR(most, bears * area, 2e-3 * bears * area);
  EXPECT_EQ(d.state().bond, 0.0);
  EXPECT_NEAR(last, bond.broken_friction * pressure * area, 2e-2 * last);
  EXPECT_GT(d.slid(), 0.0);
  EXPECT_LT(std::fabs(d.missing()), 1e-4 * d.work());
}

TEST(ParallelBond, random_walks_lose_no_energy_that_is_not_booked) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int walk = 0; walk < 20; ++walk) {
    Driver d(bond);
    const double stretch = 3e-3 * bond.tensile_strength / modulus * length / d.dt();
    for (int i = 0; i < 20'000; ++i)
      d.move({stretch * normal(random), stretch * normal(random), stretch * normal(random)},
             {stretch / radius * normal(random), stretch / radius * normal(random), 0.0});
    EXPECT_LT(std::fabs(d.missing()), 1e-3 * std::max(1e-3, std::fabs(d.work()))) << walk;
  }
}

TEST(ParallelBond, it_lets_go_of_ends_that_have_parted) {
  Driver d(bond);
  for (int i = 0; i < 1'000; ++i) d.move({2e-5 / d.dt(), 0.0, 0.0});
  EXPECT_EQ(d.state().bond, bond_released);
}

}  // namespace parallel_bond_test
}  // namespace breccia::dem
