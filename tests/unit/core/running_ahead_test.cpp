// How many steps are launched ahead of a device.

#include <gtest/gtest.h>

#include "core/device_run.hpp"

namespace breccia {
namespace {

/// A step is counted by the one after it: of one alone the host would never hear.
TEST(RunningAhead, launches_two_steps_however_long_they_take) {
  for (const double seconds : {0.0, 1e-7, 1e-5, 1e-4, 1e-3, 1.0, 1e3}) {
    double pace = seconds;
    const RunningAhead running(pace);
    EXPECT_GE(running.ahead(), 2) << seconds;
    EXPECT_LE(running.ahead(), 12) << seconds;
  }
}
TEST(RunningAhead, records_no_steps_that_take_longer_than_the_host_is_away) {
  double pace = 1e-3;
  const RunningAhead running(pace);
  EXPECT_EQ(running.ahead(), 2);
  EXPECT_FALSE(running.records(1000));
  EXPECT_FALSE(running.replays());
  pace = 1e-5;
  EXPECT_EQ(running.ahead(), 12);
  EXPECT_TRUE(running.records(0));
  EXPECT_TRUE(running.replays());
  pace = 1e-4;
  EXPECT_EQ(running.ahead(), 4);
  EXPECT_FALSE(running.records(0));
  EXPECT_TRUE(running.records(64));
}

}  // namespace
}  // namespace breccia
