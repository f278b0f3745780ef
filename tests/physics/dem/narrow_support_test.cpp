// Supports that hold a body by few elements are told of before the run.

#include <gtest/gtest.h>

#include "physics/dem/scene.hpp"

namespace breccia::dem {
namespace narrow_support_test {

using testing::Scene;

/// A row of linked spheres, of which a support holds those up to x.
std::vector<std::string> told(double x, const std::vector<std::string>& fix, int spheres = 250) {
  Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2500.0);
  for (int i = 0; i < spheres; ++i) {
    s.sphere({0.02 * i, 0.0, 0.0}, 0.01);
    if (i > 0) s.link(i - 1, i);
  }
  s.config.supports.push_back({"clamp", "", {-1.0, -1.0, -1.0}, {x, 1.0, 1.0}, fix, {}, 0.0});
  return s.world().given->warnings;
}

TEST(NarrowSupport, is_told_with_what_joins_it_to_the_rest) {
  const std::vector<std::string> warnings = told(0.05, {"z"});
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(warnings[0].starts_with("support.clamp: it holds 3 elements, which 1 link joins"))
      << warnings[0];
}

TEST(NarrowSupport, of_many_elements_or_of_none_that_is_held_in_place_is_not) {
  EXPECT_TRUE(told(0.5, {"z"}).empty());
  EXPECT_TRUE(told(0.05, {"spin_x"}).empty());
  EXPECT_TRUE(told(0.05, {"z"}, 20).empty());  // a small scene is meant
}

}  // namespace narrow_support_test
}  // namespace breccia::dem
