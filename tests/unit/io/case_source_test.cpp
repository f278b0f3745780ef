#include "io/case/case_source.hpp"

#include <gtest/gtest.h>

#include "dem/setup/config.hpp"
#include "exec/error.hpp"
#include "run/case_keys.hpp"

namespace breccia {
namespace case_source_test {

std::string repeated(const std::string& part, int count) {
  std::string text;
  for (int k = 0; k < count; ++k) text += part;
  return text;
}

std::string message_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read_case<dem::Config>(CaseText{text, "deep.toml"}, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no problem";
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CaseSource, keys_nested_without_end_are_refused_and_do_not_use_up_the_stack) {
  const std::string key = "a" + repeated(".a", 100000);
  EXPECT_TRUE(mentions(message_of("\n[" + key + "]\n"), "line 2: a key has more than 16 parts"));
  EXPECT_TRUE(mentions(message_of(key + " = 1\n"), "line 1: a key has more than 16 parts"));
  EXPECT_TRUE(mentions(message_of("", {key + "=1"}), "a key has more than 16 parts"));
  EXPECT_TRUE(mentions(message_of("x = " + repeated("{a.a.a.a.a = ", 200)), "more than 16 parts"));
  EXPECT_TRUE(mentions(message_of("x = " + repeated("[", 100000)), "maximum nested value depth"));
}

TEST(CaseSource, dots_in_texts_comments_and_numbers_are_no_keys) {
  const std::string dots(40, '.');
  check_case_source("title = \"" + dots + "\\\"" + dots + "\"\n", "");
  check_case_source("title = '" + dots + "'  # " + dots + "\n", "");
  check_case_source("title = \"\"\"\n\"" + dots + "\\\n" + dots + "\"\"\"\n# " + dots, "");
  check_case_source("x = [" + repeated("0.5, ", 40) + "]\n", "");
  EXPECT_THROW(check_case_source("title = \"\"" + dots, ""), InputError);
}

TEST(CaseSource, a_line_of_a_mebibyte_and_a_file_of_16_are_the_limit) {
  const std::string line(1 << 20, '#');
  check_case_source(line + "\n", "");
  EXPECT_TRUE(mentions(message_of("\n" + line + "#\n"), "line 2 is longer than 1 MiB"));
  const std::string half = std::string(1 << 19, '#') + "\n";
  EXPECT_TRUE(mentions(message_of(repeated(half, 32)), "larger than 16 MiB"));
}

}  // namespace case_source_test
}  // namespace breccia
