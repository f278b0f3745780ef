// Hints for words that are no key or no name.

#include "io/case/suggestion.hpp"

#include <gtest/gtest.h>

namespace breccia {
namespace suggestion_test {

TEST(Suggestion, says_what_a_specimens_strength_belongs_to) {
  const std::set<std::string> links{"cohesion", "tensile_strength", "young"},
      joints{"cohesion", "friction_angle", "tension"};
  for (const char* word : {"compression", "compressive_strength", "fc", "f_c", "UCS"}) {
    EXPECT_NE(suggestion(word, links).find("breccia calibrate"), std::string::npos) << word;
    EXPECT_NE(suggestion(word, joints).find("UCS (1 - sin a)/(2 cos a)"), std::string::npos)
        << word;
  }
  EXPECT_EQ(suggestion("cohesoin", links), "; did you mean cohesion?");
}

TEST(Suggestion, of_a_class_of_concrete_is_one_of_its_first_half) {
  EXPECT_EQ(suggestion("C30/37", {"C20", "C30", "C40", "S355"}), "; did you mean C30?");
  const std::string between = suggestion("C35/45", {"C20", "C30", "C40", "S355"});
  EXPECT_TRUE(between == "; did you mean C30?" || between == "; did you mean C40?") << between;
}

TEST(Suggestion, knows_words_of_other_programs) {
  EXPECT_EQ(suggestion("dip", {"angle", "gap"}), "; did you mean angle?");
  EXPECT_EQ(suggestion("yield_force", {"yield", "young"}), "; did you mean yield?");
}

}  // namespace suggestion_test
}  // namespace breccia
