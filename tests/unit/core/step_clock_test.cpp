// The clock of a device, driven by hand on the host, and the choice of items that searches use.

#include "core/step_clock.hpp"

#include <gtest/gtest.h>

#include "core/select.hpp"

namespace breccia {
namespace {

struct TwiceTheLeast {
  BR_HD double operator()(double least, double) const { return 2.0 * least; }
};

/// One step whose least number is `least`.
void finish(Buffer<StepClock>& clock, double least, int evaluate_every = 1) {
  if (clock.data()->halted == 0) clock.data()->least = ordered_bits(least);
  FinishStep<TwiceTheLeast>{{}, evaluate_every, clock.view()}(0);
}

Buffer<StepClock> started(const StopAt& stop) {
  Buffer<StepClock> clock(Space::host, 1);
  StepClock start;
  start.now = {1.0, 0.0, 0.5};
  start.stop = stop;
  *clock.data() = start;
  return clock;
}

TEST(StepClock, HaltsAtTheFirstStepAtOrPastItsEnd) {
  StopAt stop;
  stop.time = 2.0;
  Buffer<StepClock> clock = started(stop);
  const StepClock& c = *clock.data();
  finish(clock, 0.25);
  EXPECT_EQ(c.now.time, 1.5);
  EXPECT_EQ(c.now.last_dt, 0.5);
  EXPECT_EQ(c.now.next_dt, 0.5);
  EXPECT_EQ(c.halted, 0);
  finish(clock, 0.125);
  EXPECT_EQ(c.now.time, 2.0);
  EXPECT_EQ(c.now.next_dt, 0.25);
  EXPECT_EQ(c.halted, 1);
  finish(clock, 0.125);  // launched ahead: nothing
  EXPECT_EQ(c.step, 2);
  EXPECT_EQ(c.now.time, 2.0);
}

TEST(StepClock, WaitsForTheHostInTheMiddleOfAStep) {
  Buffer<StepClock> clock = started({});
  clock.data()->wanted = 1;
  finish(clock, 0.25);
  EXPECT_EQ(clock.data()->halted, 1);
  EXPECT_EQ(clock.data()->now.time, 1.5);     // elements have moved
  EXPECT_EQ(clock.data()->now.next_dt, 0.5);  // forces and the next step are the host's
  EXPECT_EQ(clock.data()->step, 0);
}

TEST(StepClock, EvaluatesTheStepAsOftenAsTheCaseSays) {
  Buffer<StepClock> clock = started({});
  finish(clock, 0.1, 2);
  EXPECT_EQ(clock.data()->now.next_dt, 0.2);
  finish(clock, 0.3, 2);
  EXPECT_EQ(clock.data()->now.next_dt, 0.2);
  EXPECT_EQ(clock.data()->dt_min, 0.2);
  EXPECT_EQ(clock.data()->dt_max, 0.5);
}

TEST(StepClock, BitsOfNumbersAreOrderedLikeThem) {
  const double numbers[] = {0.0, 5e-324, 1e-9, 1.0, 1.0000000000000002, 1e300};
  for (int i = 0; i + 1 < 6; ++i) EXPECT_LT(ordered_bits(numbers[i]), ordered_bits(numbers[i + 1]));
  EXPECT_EQ(number_of(ordered_bits(0.7)), 0.7);
}

struct EveryThird {
  BR_HD bool operator()(Index i) const { return i % 3 == 2; }
};

TEST(Select, ListsWhatIsKeptInAscendingOrder) {
  for (const int threads : {1, 3}) {
    Exec exec;
    exec.threads = threads;
    const Buffer<Index> kept = items_where(exec, 2000, EveryThird{});
    ASSERT_EQ(kept.size(), 666);
    for (Index i = 0; i < kept.size(); ++i) EXPECT_EQ(kept.data()[i], 3 * i + 2);
    EXPECT_EQ(items_where(exec, 0, EveryThird{}).size(), 0);
  }
}

}  // namespace
}  // namespace breccia
