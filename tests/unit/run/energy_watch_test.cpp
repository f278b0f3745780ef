#include "run/machine/energy_watch.hpp"

#include <gtest/gtest.h>

#include "exec/error.hpp"

namespace breccia {
namespace energy_watch_test {

EnergyBalance with_error(double error) {
  EnergyBalance energy;
  energy.work = 1.0;
  energy.kinetic = 1.0 + error;
  energy.error_relative = error;
  return energy;
}

TEST(EnergyWatch, an_error_that_fades_after_the_start_is_no_fault) {
  EnergyWatch watch(EnergyConfig{});
  for (int row = 0; row < 1000; ++row)
    EXPECT_FALSE(watch.look(with_error(row < 24 ? 0.5 : 1e-4), 1000 + row, 0.0));
  EXPECT_NO_THROW(watch.judge_end(with_error(1e-4), 1000, 1.0));
}

TEST(EnergyWatch, an_error_that_stays_is_a_warning_and_then_an_end) {
  EnergyWatch watch(EnergyConfig{});
  int warnings = 0;
  for (int row = 0; row < 100; ++row) warnings += watch.look(with_error(2e-3), 5000 + row, 0.0);
  EXPECT_EQ(warnings, 1);
  for (int row = 0; row < 24; ++row) watch.look(with_error(0.02), 5000 + row, 0.0);
  try {
    watch.look(with_error(0.02), 777, 0.5);
    FAIL() << "it goes on";
  } catch (const NumericsError& error) {
    const std::string told = error.what();
    EXPECT_TRUE(told.starts_with("step 777, t = 5.000000e-01 s: 0.02 J of 1 J are missing"))
        << told;
  }
}

TEST(EnergyWatch, what_is_as_small_as_the_rounding_of_sums_is_not_judged) {
  EnergyWatch watch(EnergyConfig{});
  EnergyBalance rest = with_error(0.7);
  rest.work *= 9e-19;
  rest.kinetic *= 9e-19;
  for (int row = 0; row < 100; ++row) EXPECT_FALSE(watch.look(rest, 5000 + row, 0.0));
  EXPECT_FALSE(watch.judge_end(rest, 5100, 1.0));
}

EnergyBalance growing(double work, double error) {
  EnergyBalance energy = with_error(error);
  energy.work *= work;
  energy.kinetic *= work;
  return energy;
}

TEST(EnergyWatch, an_error_of_energies_that_grow_is_counted_anew_with_each_doubling) {
  EnergyWatch watch(EnergyConfig{});
  int warnings = 0;
  double work = 1e-3;
  for (int row = 0; row < 200; ++row, work *= 1.04)
    warnings += watch.look(growing(work, 2e-3), 5000 + row, 0.0);
  EXPECT_EQ(warnings, 0) << "doubles every 18 rows";
  for (int row = 0; row < 40; ++row, work *= 1.02)
    warnings += watch.look(growing(work, 2e-3), 5000 + row, 0.0);
  EXPECT_EQ(warnings, 1) << "doubles every 35 rows";
  for (int row = 0; row < 200; ++row, work *= 1.04)
    warnings += watch.look(growing(work, 2e-3), 5000 + row, 0.0);
  EXPECT_EQ(warnings, 1) << "told once, as long as it stays";
}

TEST(EnergyWatch, growth_does_not_put_off_the_end_of_a_run) {
  EnergyWatch watch(EnergyConfig{});
  double work = 1.0;
  for (int row = 0; row < 24; ++row, work *= 2.0) watch.look(growing(work, 0.02), 5000 + row, 0.0);
  EXPECT_THROW(watch.look(growing(work, 0.02), 5024, 0.0), NumericsError);
}

/// What was missed once is less and less of energies that grow, at any start of theirs; what goes
/// on to be missed is not, nor is what grows with them.
TEST(EnergyWatch, an_error_that_fades_slowly_ends_no_run) {
  for (const double missed : {1.0, 0.0}) {
    EnergyWatch watch(EnergyConfig{});
    const auto run = [&] {
      for (int row = 25; row < 1000; ++row) {
        const double work = 1e-3 * row * row;
        watch.look(growing(work, 0.3 * (missed > 0.0 ? 0.625 / work : 1.0)), 500 * row, 0.0);
      }
    };
    if (missed > 0.0)
      EXPECT_NO_THROW(run());
    else
      EXPECT_THROW(run(), NumericsError);
  }
}

TEST(EnergyWatch, a_warning_put_off_is_given_at_the_end) {
  EnergyWatch watch(EnergyConfig{});
  double work = 1.0;
  for (int row = 0; row < 200; ++row, work *= 1.04)
    watch.look(growing(work, 2e-3), 5000 + row, 0.0);
  EXPECT_TRUE(watch.judge_end(growing(work, 2e-3), 5200, 1.0));
  EXPECT_FALSE(watch.judge_end(growing(work, 9e-4), 5200, 1.0));
  EnergyWatch told(EnergyConfig{});
  for (int row = 0; row < 30; ++row) told.look(with_error(2e-3), 5000 + row, 0.0);
  EXPECT_FALSE(told.judge_end(with_error(2e-3), 5030, 1.0));
}

TEST(EnergyWatch, the_end_of_a_case_is_judged_by_its_last_row) {
  const EnergyWatch watch(EnergyConfig{});
  EXPECT_NO_THROW(watch.judge_end(with_error(0.009), 900, 1.0));
  EXPECT_THROW(watch.judge_end(with_error(0.011), 900, 1.0), NumericsError);
}

/// What one step moves in the mean is not known of a load that has just begun.
TEST(EnergyWatch, less_than_a_step_moves_is_not_judged) {
  EnergyWatch watch(EnergyConfig{});
  EXPECT_FALSE(watch.judge_end(with_error(0.029), 1, 1e-8));
  EXPECT_FALSE(watch.judge_end(with_error(0.24), 4, 1e-7));
  EXPECT_THROW(watch.judge_end(with_error(0.26), 4, 1e-7), NumericsError);
  EXPECT_THROW(watch.judge_end(with_error(0.011), 100, 1.0), NumericsError);
  for (int step = 1; step <= 99; ++step) EXPECT_FALSE(watch.look(with_error(0.01), step, 0.0));
  EXPECT_FALSE(watch.judge_end(with_error(9.9e-4), 1001, 1.0));
  EXPECT_TRUE(watch.judge_end(with_error(1.1e-3), 1001, 1.0));
}

TEST(EnergyWatch, contacts_that_give_out_energy_are_told_once) {
  EnergyWatch watch(EnergyConfig{});
  EnergyBalance energy;
  energy.contact = -0.005;
  energy.contact_relative = 0.005;
  EXPECT_FALSE(watch.contacts_gave(energy));
  energy.contact = 0.5;  // dashpots have taken it
  energy.contact_relative = 0.5;
  EXPECT_FALSE(watch.contacts_gave(energy));
  energy.contact = -0.02;
  energy.contact_relative = 0.02;
  EXPECT_TRUE(watch.contacts_gave(energy));
  EXPECT_FALSE(watch.contacts_gave(energy));
}

TEST(EnergyWatch, limits_of_zero_switch_it_off) {
  EnergyWatch watch(EnergyConfig{0.0, 0.0});
  for (int row = 0; row < 100; ++row) EXPECT_FALSE(watch.look(with_error(0.5), 5000 + row, 0.0));
  EXPECT_NO_THROW(watch.judge_end(with_error(0.5), 900, 1.0));
}

TEST(EnergyWatch, what_cannot_be_summed_ends_the_run_at_once) {
  EnergyWatch watch(EnergyConfig{0.0, 0.0});
  EnergyBalance energy = with_error(0.0);
  energy.fracture = ExactSum(1e300).value();
  EXPECT_THROW(watch.look(energy, 1, 0.0), NumericsError);
}

}  // namespace energy_watch_test
}  // namespace breccia
