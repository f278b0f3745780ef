#include "io/harmless.hpp"

#include <gtest/gtest.h>

namespace breccia {
namespace harmless_test {

TEST(Harmless, ordinary_text_of_any_language_stays) {
  const std::string text = "b\u00e9ton 30 MPa \u2014 \u6df7\u51dd\u571f \U0001f9f1\n\tend";
  EXPECT_EQ(harmless(text), text);
  EXPECT_EQ(harmless("a\nb\tc", ""), "a\\x0ab\\x09c");
}

TEST(Harmless, what_steers_a_terminal_is_spelled_out) {
  EXPECT_EQ(harmless("\x1b[2J\r\x7f"), "\\x1b[2J\\x0d\\x7f");
  EXPECT_EQ(harmless(std::string("\0", 1)), "\\x00");
  EXPECT_EQ(harmless("\u009b2J"), "\\u009b2J");                                // one byte for ESC [
  EXPECT_EQ(harmless("a\u202eb\u2066c\u200fd"), "a\\u202eb\\u2066c\\u200fd");  // turns the order
}

TEST(Harmless, bytes_that_are_no_text_are_spelled_out) {
  EXPECT_EQ(harmless("\x9b"), "\\x9b");
  EXPECT_EQ(harmless("\xc3"), "\\xc3");             // ends too early
  EXPECT_EQ(harmless("\xe2\x82x"), "\\xe2\\x82x");  // ends too early
  EXPECT_EQ(harmless("\xc0\xaf"), "\\xc0\\xaf");    // longer than needed
  EXPECT_EQ(harmless("\xff\xfe"), "\\xff\\xfe");
}

}  // namespace harmless_test
}  // namespace breccia
