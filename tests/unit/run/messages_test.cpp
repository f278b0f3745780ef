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

}  // namespace messages_test
}  // namespace breccia
