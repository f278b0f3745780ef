// The rule by which a probe ends a stage.

#include <gtest/gtest.h>

#include "core/stages.hpp"

namespace breccia {
namespace probe_rule_test {

TEST(ProbeRule, knows_four_signs) {
  const double limit = 2.5;
  const struct {
    const char* text;
    bool below, equal, above;
  } rules[] = {{"f < 2.5", true, false, false},
               {"f<=2.5", true, true, false},
               {"f > 2.5", false, false, true},
               {" f  >=  2.5 ", false, true, true}};
  for (const auto& r : rules) {
    const auto rule = ProbeRule::parsed(r.text);
    ASSERT_TRUE(rule) << r.text;
    EXPECT_EQ(rule->probe, "f");
    EXPECT_EQ(rule->holds(limit - 1e-9), r.below) << r.text;
    EXPECT_EQ(rule->holds(limit), r.equal) << r.text;
    EXPECT_EQ(rule->holds(limit + 1e-9), r.above) << r.text;
  }
}

TEST(ProbeRule, tells_the_unit_behind_the_number) {
  const auto rule = ProbeRule::parsed("side force < -2.5e3 kN/m");
  ASSERT_TRUE(rule);
  EXPECT_EQ(rule->probe, "side force");
  EXPECT_EQ(rule->limit, -2500.0);
  EXPECT_EQ(rule->unit, "kN/m");
}

TEST(ProbeRule, is_nothing_else) {
  for (const char* text : {"f", "f = 2", "f == 2", "f != 2", "f => 2", "f =< 2", "> 2", "f >",
                           "f > x", "f > 2 & g < 1", "f > 2, g", "f >> 2", "f <> 2", "1 < f < 2"})
    EXPECT_FALSE(ProbeRule::parsed(text)) << text;
}

TEST(ProbeRule, problems_say_what_is_allowed) {
  StageEnd first, last;
  first.name = "a";
  first.when = "f = 2";
  last.name = "b";
  const auto said = stage_problems({first, last}, {"f"}, {});
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0],
            "stage.a.when = \"f = 2\" is not of the form \"probe > 2 kN\": the name of one probe, "
            "one of <, <=, > and >=, and a number, with a unit or in SI");
}

}  // namespace probe_rule_test
}  // namespace breccia
