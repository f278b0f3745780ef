// The line of progress on narrow terminals, and spans of wall-clock time as people write them.

#include "run/results/progress.hpp"

#include <gtest/gtest.h>

namespace breccia {
namespace progress_test {

const std::vector<std::string> pieces{" 42 %",        "left 4 min 05 s",    "1.68 ms",
                                      "broken 6,199", "energy error 2e-05", "1,234 steps/s"};

TEST(ProgressLine, is_never_wider_than_the_terminal_and_keeps_what_matters_most) {
  for (std::size_t width = 0; width < 200; ++width) {
    const std::string line = progress_line(0.42, pieces, width);
    EXPECT_LE(line.size(), width);
    if (width >= 24) {
      EXPECT_NE(line.find("left 4 min 05 s"), std::string::npos) << width;
    }
  }
  EXPECT_NE(progress_line(0.42, pieces, 79).find("energy error"), std::string::npos);
  EXPECT_EQ(progress_line(0.42, pieces, 79).find("steps/s"), std::string::npos);
}

TEST(ProgressLine, fills_its_bar_by_the_share_that_is_done) {
  const std::string line = progress_line(0.5, pieces, 120);
  EXPECT_EQ(line.substr(0, 26), "[############............]");
}

TEST(WallTime, is_read_as_people_write_it) {
  EXPECT_EQ(wall_time("45"), 45.0);
  EXPECT_EQ(wall_time("90m"), 5400.0);
  EXPECT_EQ(wall_time("3h50m"), 13800.0);
  EXPECT_EQ(wall_time("1.5h"), 5400.0);
  EXPECT_EQ(wall_time("00:45:00"), 2700.0);
  EXPECT_EQ(wall_time("2:30"), 150.0);
  for (const char* wrong : {"", "0", "-3", "8x", "h", "1:", "1:2h", "inf", "nan", "1 h"})
    EXPECT_FALSE(wall_time(wrong)) << wrong;
}

}  // namespace progress_test
}  // namespace breccia
