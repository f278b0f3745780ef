// Lines that fit a terminal.

#include "io/fold.hpp"

#include <gtest/gtest.h>

namespace breccia {
namespace fold_test {

TEST(Fold, breaks_long_lines_at_blanks_and_indents_the_rest) {
  EXPECT_EQ(folded("shows   one two three\n", 14, 8), "shows   one\n        two\n        three\n");
  EXPECT_EQ(folded("short\n\nlong and longer\n", 8, 2), "short\n\nlong and\n  longer\n");
  EXPECT_EQ(folded("no end", 4, 0), "no\nend");
}

TEST(Fold, leaves_what_fits_and_words_that_cannot) {
  for (const char* text : {"", "\n", "a b c\n", "12345678\n", "a  b\n", "/a/very/long/path\n"})
    EXPECT_EQ(folded(text, 8, 2), text);
  EXPECT_EQ(folded("see /a/very/long/path now\n", 8, 4), "see\n    /a/very/long/path\n    now\n");
}

TEST(Fold, counts_characters_and_not_bytes) {
  EXPECT_EQ(folded("\u00b5s \u00b5s \u00b5s", 8, 0), "\u00b5s \u00b5s \u00b5s");
}

TEST(Fold, is_for_terminals_alone) {
  std::FILE* const file = std::tmpfile();
  const std::string text(300, 'a');
  EXPECT_EQ(fitting(text + " b", 0, file), text + " b");
  std::fclose(file);
}

}  // namespace fold_test
}  // namespace breccia
