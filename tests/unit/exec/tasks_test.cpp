#include "exec/tasks.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace breccia {
namespace tasks_test {

TEST(tasks, each_is_done_once_on_any_number_of_threads) {
  for (const int threads : {1, 2, 7})
    for (const int count : {0, 1, 2, 100}) {
      std::vector<int> done(static_cast<std::size_t>(count), 0);
      for_each_task(threads, count, [&](int i) { ++done[static_cast<std::size_t>(i)]; });
      EXPECT_EQ(done, std::vector<int>(static_cast<std::size_t>(count), 1)) << threads;
    }
}

TEST(tasks, the_first_one_that_fails_is_told_of_after_all_have_ended) {
  for (const int threads : {1, 3}) {
    std::vector<int> done(50, 0);
    try {
      for_each_task(threads, 50, [&](int i) {
        if (i == 11 || i == 40) throw std::runtime_error(std::to_string(i));
        done[static_cast<std::size_t>(i)] = 1;
      });
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "11");
    }
    EXPECT_EQ(done[49], 1);
  }
}

}  // namespace tasks_test
}  // namespace breccia
