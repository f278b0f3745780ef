// The gas of an explosive: what it sets free, and at which pressure.

#include "fdem_shared/laws/explosive.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace breccia::fdem {
namespace explosive_test {

// ANFO of 0.931 g/cm3 (Dobratz and Crawford 1985, UCRL-52997).
constexpr double a = 49.46e9, b = 1.891e9, r1 = 3.907, r2 = 1.118, omega = 0.333, energy = 2.484e9;
const fdem_shared::ExplosiveGas gas = fdem_shared::ExplosiveGas::of(a, b, r1, r2, omega, energy);

/// p = A (1 - omega/(R_1 V)) e^(-R_1 V) + B (1 - omega/(R_2 V)) e^(-R_2 V) + omega E/V with the
/// energy that is left: the equation of state, at every volume of the expansion.
TEST(Explosive, keeps_to_the_equation_of_state_as_it_expands) {
  for (const double v : {0.7, 1.0, 1.5, 3.0, 10.0, 100.0}) {
    const double expected = a * (1.0 - omega / (r1 * v)) * std::exp(-r1 * v) +
                            b * (1.0 - omega / (r2 * v)) * std::exp(-r2 * v) +
                            omega * gas.energy(v) / v;
    EXPECT_NEAR(gas.pressure(v), expected, 1e-12 * expected) << v;
  }
}

TEST(Explosive, holds_its_energy_at_first_and_gives_all_of_it) {
  EXPECT_NEAR(gas.energy(1.0), energy, 1e-12 * energy);
  double given = 0.0;  // by Simpson's rule over ln V
  const int steps = 4000;
  const double h = std::log(1e6) / steps;
  for (int i = 0; i <= steps; ++i) {
    const double v = std::exp(i * h), weight = i == 0 || i == steps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    given += weight * h / 3.0 * gas.pressure(v) * v;
  }
  EXPECT_NEAR(given + gas.energy(1e6), energy, 1e-7 * energy);
  EXPECT_LT(gas.energy(1e6), 0.02 * energy);
}

TEST(Explosive, has_the_pressure_of_its_volume_and_energy) {
  for (const double v : {1.0, 2.0, 7.0, 60.0})
    EXPECT_NEAR(gas.pressure(v, gas.energy(v)), gas.pressure(v), 1e-12 * gas.pressure(v)) << v;
  const auto ideal = fdem_shared::ExplosiveGas::of(0.0, 0.0, r1, r2, omega, energy);
  EXPECT_NEAR(ideal.pressure(3.0, energy), omega * energy / 3.0, 1e-12 * energy);
}
/// Entropy grows: what runs into empty room presses harder than what works on the way.
TEST(Explosive, that_does_not_work_stays_hotter) {
  for (const double v : {1.5, 4.0, 20.0}) EXPECT_GT(gas.pressure(v, energy), gas.pressure(v)) << v;
}

TEST(Explosive, is_an_ideal_gas_in_the_end) {
  EXPECT_NEAR(gas.pressure(200.0) / gas.pressure(100.0), std::pow(2.0, -1.0 - omega), 1e-12);
}

}  // namespace explosive_test
}  // namespace breccia::fdem
