// Ranks that fall silent are noticed; those that are only slow, or done, are not.

#include "domain/watchdog.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>

namespace breccia {
namespace watchdog_test {

void pass(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// Two ranks' signs, and whom the first one has lost: -1 nobody.
struct Pair {
  std::array<LifeSign, 2> signs{};
  std::atomic<int> lost = -1;
  Watchdog first{signs, 0, [this](std::size_t who) { lost = static_cast<int>(who); }};
};

TEST(Watchdog, a_process_without_a_sign_of_life_is_lost_after_the_patience) {
  Pair pair;  // nobody beats for the second rank
  pair.first.set_patience(0.4);
  pass(0.1);
  EXPECT_EQ(pair.lost, -1);
  for (int i = 0; i < 100 && pair.lost < 0; ++i) pass(0.05);
  EXPECT_EQ(pair.lost, 1);
}

TEST(Watchdog, ranks_that_run_or_have_ended_are_not_lost_however_busy) {
  Pair pair;
  {
    Watchdog second(pair.signs, 1, [](std::size_t) {});
    pair.first.set_patience(1.0);
    pass(1.5);
    EXPECT_EQ(pair.lost, -1);
  }
  pass(1.5);
  EXPECT_EQ(pair.lost, -1);
}

TEST(Watchdog, nobody_is_lost_where_patience_is_endless) {
  Pair pair;
  pair.first.begin_waiting();
  pass(1.2);
  EXPECT_EQ(pair.lost, -1);
}

TEST(Watchdog, a_rank_that_lives_but_never_answers_is_lost_after_ten_times_the_patience) {
  Pair pair;
  Watchdog second(pair.signs, 1, [](std::size_t) {});
  pair.first.set_patience(0.2);
  pair.first.begin_waiting();
  pair.first.end_waiting();
  pair.first.begin_waiting();
  pass(0.8);
  EXPECT_EQ(pair.lost, -1);
  for (int i = 0; i < 100 && pair.lost < 0; ++i) pass(0.1);
  EXPECT_EQ(pair.lost, 1);
}

}  // namespace watchdog_test
}  // namespace breccia
