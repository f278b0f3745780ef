// What set-up says of models that can be run, but should be looked at.

#include <gtest/gtest.h>

#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace {

using namespace testing;

TEST(FdemWarnings, name_the_sliver_that_rules_the_step) {
  Scene scene;
  scene.material();
  scene.body("plate", prepare::equilateral_rectangle({{0.0, 0.0}, {0.02, 0.01}}, 1e-3));
  EXPECT_TRUE(scene.world().warnings.empty());
  scene.triangle("sliver", {0.05, 0.0}, {0.051, 0.0}, {0.0505, 1e-5});
  const std::vector<std::string> said = scene.world().warnings;
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("(sliver) at (0.0505, 3.33333e-06) m"), std::string::npos) << said[0];
  EXPECT_NE(said[0].find("times shorter than the median"), std::string::npos) << said[0];
}

}  // namespace
}  // namespace breccia::fdem
