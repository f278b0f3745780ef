#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "dem/setup/config.hpp"
#include "io/case/case_file.hpp"

namespace breccia {
namespace {

const KeyInfo* find(const std::vector<KeyInfo>& keys, const std::string& path) {
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const KeyInfo& k) { return k.path == path; });
  return found == keys.end() ? nullptr : &*found;
}

std::size_t count(const std::string& prefix) {
  return list_keys<dem::Config>(prefix).size();
}

TEST(Keys, each_is_listed_with_type_unit_default_range_and_meaning) {
  const std::vector<KeyInfo> keys = list_keys<dem::Config>("");
  const KeyInfo* const young = find(keys, "material.<name>.young");
  ASSERT_NE(young, nullptr);
  EXPECT_EQ(young->type, "number");
  EXPECT_EQ(young->unit, "Pa");
  EXPECT_EQ(std::stod(young->default_text), 30e9);
  EXPECT_EQ(young->range, "[1000, 1e+13]");
  EXPECT_EQ(young->meaning, "Young's modulus of the bulk material");
  const KeyInfo* const shape = find(keys, "body[].shape");
  ASSERT_NE(shape, nullptr);
  EXPECT_EQ(shape->type, "word");
  EXPECT_EQ(shape->default_text, "\"box\"");
  EXPECT_EQ(shape->range, "box | sphere | cylinder | element | rebar | file");
  ASSERT_NE(find(keys, "body[].pack.count"), nullptr);
  EXPECT_EQ(find(keys, "body[].pack.count")->default_text, "(required)");
}

TEST(Keys, a_prefix_needs_no_brackets_and_no_names) {
  EXPECT_EQ(count("body.pack"), 3U);
  EXPECT_EQ(count("body[].pack"), 3U);
  EXPECT_EQ(count("material.slip"), 4U);
  EXPECT_EQ(count("material.<name>.slip"), 4U);
  EXPECT_EQ(count("slip"), 0U);
}

TEST(Keys, the_table_fits_100_columns_and_its_columns_are_aligned) {
  std::istringstream text(format_keys(list_keys<dem::Config>("")));
  std::string line;
  std::size_t rows = 0, type_at = std::string::npos;
  while (std::getline(text, line)) {
    EXPECT_LE(line.size(), 100U) << line;
    EXPECT_FALSE(line.ends_with(' ')) << line;
    if (line.starts_with("key ")) type_at = line.find("type");
    if (line.starts_with(' ')) continue;
    ++rows;
    ASSERT_LT(type_at, line.size());
    EXPECT_EQ(line.substr(type_at - 2, 2), "  ") << line;
    EXPECT_NE(line[type_at], ' ') << line;
  }
  EXPECT_EQ(rows, 1 + count(""));
}

}  // namespace
}  // namespace breccia
