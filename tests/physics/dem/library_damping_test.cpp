// Concretes of the library belong to links that damp, and to no local damping.

#include <gtest/gtest.h>

#include "physics/dem/scene.hpp"

namespace breccia::dem {
namespace library_damping_test {

using testing::Scene;

std::vector<std::string> told(const std::string& use, double damping, double of_links = 0.0,
                              bool stage = false) {
  Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2500.0);
  s.config.materials.back().use = use;
  s.config.materials.back().link_damping = of_links;
  s.config.local_damping = damping;
  if (stage) {
    s.config.stages.emplace_back().name = "settle";
    s.config.stages.back().local_damping = damping;
  }
  s.sphere({0.0, 0.0, 0.0}, 0.01);
  s.sphere({0.02, 0.0, 0.0}, 0.01);
  s.link(0, 1);
  return s.world().given->warnings;
}

TEST(LibraryDamping, is_told_of_where_links_of_a_case_do_not_damp) {
  const std::vector<std::string> warnings = told("C30", 0.0);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(warnings[0].starts_with(
      "material.c: C30 was found with link_damping = 0.3, and this case has 0:"))
      << warnings[0];
}

TEST(LibraryDamping, is_told_of_where_local_damping_comes_on_top) {
  const std::vector<std::string> warnings = told("C30", 0.5, 0.3);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(warnings[0].starts_with(
      "material.c: C30 was found without local damping, and this case has 0.5:"))
      << warnings[0];
}

TEST(LibraryDamping,
     is_not_told_of_as_found_or_where_a_stage_settles_or_of_a_material_of_ones_own) {
  EXPECT_TRUE(told("C30", 0.0, 0.3).empty());
  EXPECT_TRUE(told("C30", 0.5, 0.3, true).empty());
  EXPECT_TRUE(told("", 0.5).empty());
}

}  // namespace library_damping_test
}  // namespace breccia::dem
