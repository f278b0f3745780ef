// The clock of a device, driven by hand on the host, and the choice of items that searches use.

#include <gtest/gtest.h>

#include "core/select.hpp"
#include "core/timed.hpp"

namespace breccia {
namespace step_clock_test {

struct TwiceTheLeast {
  BR_HD double operator()(double least, double) const { return 2.0 * least; }
};

/// One step whose least number is `least`, and its end.
void take(StepClock& clock, double least, int evaluate_every = 1) {
  if (clock.halted == 0 && clock.open == 0) clock.open = step_open;
  clock.least = ordered_bits(least);
  EndOfStep<TwiceTheLeast>{{}, evaluate_every}(clock);
}

StepClock started(const StopAt& stop) {
  StepClock start;
  start.now = {1.0, 0.0, 0.5};
  start.stop = stop;
  return start;
}

TEST(StepClock, HaltsAtTheFirstStepAtOrPastItsEnd) {
  StopAt stop;
  stop.time = 2.0;
  StepClock c = started(stop);
  take(c, 0.25);
  EXPECT_EQ(c.now.time, 1.5);
  EXPECT_EQ(c.now.last_dt, 0.5);
  EXPECT_EQ(c.now.next_dt, 0.5);
  EXPECT_EQ(c.halted, 0);
  take(c, 0.125);
  EXPECT_EQ(c.now.time, 2.0);
  EXPECT_EQ(c.now.next_dt, 0.25);
  EXPECT_EQ(c.halted, 1);
  take(c, 0.125);  // launched ahead: nothing
  EXPECT_EQ(c.now.step, 2);
  EXPECT_EQ(c.now.time, 2.0);
}

TEST(StepClock, WaitsForTheHostInTheMiddleOfAStepAndGoesOnThere) {
  StepClock c = started({});
  c.host_request = 1;
  take(c, 0.25);
  EXPECT_EQ(c.halted, 1);
  EXPECT_EQ(c.now.time, 1.5);     // elements have moved
  EXPECT_EQ(c.now.next_dt, 0.5);  // forces and the next step are still to come
  EXPECT_EQ(c.now.step, 0);
  c.host_request = c.halted = 0;
  c.open = step_open_after_move;
  take(c, 0.15);
  EXPECT_EQ(c.now.time, 1.5);
  EXPECT_EQ(c.now.last_dt, 0.5);
  EXPECT_EQ(c.now.next_dt, 0.3);
  EXPECT_EQ(c.now.step, 1);
}

TEST(StepClock, EndsNoStepTwice) {
  StepClock c = started({});
  take(c, 0.25);
  EndOfStep<TwiceTheLeast>{{}, 1}(c);
  EXPECT_EQ(c.now.step, 1);
  EXPECT_EQ(c.now.time, 1.5);
}

TEST(StepClock, EvaluatesTheStepAsOftenAsTheCaseSays) {
  StepClock c = started({});
  take(c, 0.1, 2);
  EXPECT_EQ(c.now.next_dt, 0.2);
  take(c, 0.3, 2);
  EXPECT_EQ(c.now.next_dt, 0.2);
  EXPECT_EQ(c.dt_min, 0.2);
  EXPECT_EQ(c.dt_max, 0.5);
}

/// Writes down when it was called.
struct Called {
  StepTime* last;
  StepTime now;
  BR_HD void set(const StepTime& moment) { now = moment; }
  BR_HD void operator()(Index) const { *last = now; }
};

TEST(StepClock, OpensAStepInOneClockFromTheOther) {
  StepClock clocks[2] = {started({}), started({})};
  StepTime last{};
  const EndOfStep<TwiceTheLeast> end{{}, 1};
  const auto open = [&](int from) {
    FirstLaunch<Called, TwiceTheLeast>({&last, {}}, end, &clocks[from], &clocks[1 - from], true)(0);
  };
  open(0);
  EXPECT_EQ(last.time, 1.0);
  EXPECT_EQ(clocks[1].open, step_open);
  ClockedLaunch<Called, Phase::after_move>({&last, {}}, &clocks[1])(0);
  EXPECT_EQ(last.time, 1.5);
  EXPECT_EQ(last.last_dt, 0.5);
  clocks[1].least = ordered_bits(0.125);
  open(1);
  EXPECT_EQ(last.time, 1.5);
  EXPECT_EQ(last.next_dt, 0.25);
  EXPECT_EQ(last.step, 1);
  clocks[0].host_request = 1;  // a search is due after this move
  ClockedLaunch<Called, Phase::after_move>({&last, {}}, &clocks[0])(0);
  EXPECT_EQ(last.step, 1) << "what follows the move is left to the host";
  EXPECT_EQ(last.time, 1.5);
  last = {};
  open(0);
  EXPECT_EQ(clocks[1].halted, 1);
  EXPECT_EQ(clocks[1].host_request, 1);
  EXPECT_EQ(clocks[1].now.time, 1.75);
  EXPECT_EQ(last.time, 0.0) << "nothing runs once the clock has halted";
}

TEST(StepClock, CountsToTheSameEvaluationsWhereverItStarts) {
  const EndOfStep<TwiceTheLeast> end{{}, 3};
  for (const std::int64_t first : {0, 1, 2, 3, 7}) {
    StepClock clocks[2] = {started({}), started({})};
    for (StepClock& c : clocks) {
      c.now.step = first;
      c.to_evaluation = end.to_evaluation(first);
    }
    StepTime last{};
    for (int taken = 0; taken < 8; ++taken) {
      const int from = taken % 2;
      FirstLaunch<Called, TwiceTheLeast>({&last, {}}, end, &clocks[from], &clocks[1 - from],
                                         true)(0);
      clocks[1 - from].least = ordered_bits(1.0 + taken);
      StepClock after = clocks[1 - from];
      end(after);
      const bool evaluated = (first + taken) % 3 == 0;
      EXPECT_EQ(after.now.next_dt, evaluated ? 2.0 * (1.0 + taken) : last.next_dt) << first;
      EXPECT_EQ(after.now.step, first + taken + 1);
    }
  }
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

}  // namespace step_clock_test
}  // namespace breccia
