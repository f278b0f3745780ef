#include "run/results/messages.hpp"

#include <gtest/gtest.h>

namespace breccia {
namespace messages_test {

TEST(Messages, broken_links_are_told_where_there_are_links) {
  EXPECT_EQ(broken_text({{"model.links", 8364.0}, {"fracture.broken_links", 5638.0}}),
            "broken links 5,638");
  EXPECT_EQ(broken_text({{"model.links", 8364.0}, {"fracture.broken_links", 0.0}}),
            "broken links 0");
  EXPECT_EQ(broken_text({{"model.links", 0.0}, {"fracture.broken_links", 0.0}}), "");
  EXPECT_EQ(broken_text({{"model.joints", 12.0}, {"fracture.broken_joints", 3.0}}),
            "broken joints 3");
  EXPECT_EQ(broken_text({{"model.joints", 0.0}, {"fracture.broken_joints", 0.0}}), "");
}

TEST(Messages, steps_are_told_to_where_the_run_ends) {
  Summary s;
  s.dt_last = 1e-5;
  const auto told = [&](const RunEnd& end) { return opening_text(s, end, "r"); };
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(told({0.47}), "   about 47,000 steps to 470 ms\n")) << told({0.47});
  EXPECT_TRUE(has(told({0.47, 100}), "   100 steps\n")) << told({0.47, 100});
  const RunEnd early{.time = 0.47, .may_be_earlier = true};
  EXPECT_TRUE(has(told(early), "   at most about 47,000 steps to 470 ms\n")) << told(early);
}

}  // namespace messages_test
}  // namespace breccia
