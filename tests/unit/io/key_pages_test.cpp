#include "io/case/key_pages.hpp"

#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "coupled/setup/config.hpp"
#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"
#include "paths.hpp"
#include "run/case_keys.hpp"
#include "texts.hpp"

namespace breccia {
namespace key_pages_test {

using Json = nlohmann::ordered_json;

const KeyInfo* find(const std::vector<KeyInfo>& keys, const std::string& path) {
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const KeyInfo& k) { return k.path == path; });
  return found == keys.end() ? nullptr : &*found;
}

std::size_t count(const std::string& prefix) {
  return list_keys<dem::Config>(prefix).size();
}

std::vector<MethodKeys> methods() {
  return {{"dem3d", list_keys<dem::Config>("")},
          {"fdem2d", list_keys<fdem::Config>("")},
          {"fdem3d", list_keys<fdem3::Config>("")}};
}
KeyList all() {
  return key_list(methods());
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
  EXPECT_EQ(table_heading(*young), "[material.NAME]");
  EXPECT_EQ(example_line(*young), "young = \"30 GPa\"");
  const KeyInfo* const shape = find(keys, "body[].shape");
  ASSERT_NE(shape, nullptr);
  EXPECT_EQ(shape->type, "word");
  EXPECT_EQ(shape->default_text, "\"box\"");
  EXPECT_EQ(shape->range, "box | sphere | cylinder | stl | element | rebar | file");
  EXPECT_EQ(table_heading(*shape), "[[body]]");
  EXPECT_EQ(example_line(*find(keys, "material.<name>.friction_angle")),
            "friction_angle = \"30 deg\"");
  ASSERT_NE(find(keys, "body[].material"), nullptr);
  EXPECT_EQ(find(keys, "body[].material")->default_text, "(required)");
}

/// A line that is shown can be typed.
TEST(Keys, examples_lie_in_their_own_ranges) {
  int lists = 0;
  for (const MethodKeys& method : methods())
    for (const KeyInfo& key : method.keys) {
      const std::string line = example_line(key);
      if (key.type == "number" && key.default_text != "(required)") {
        EXPECT_TRUE(key.limits.holds(std::stod(key.default_text))) << key.path << ": " << line;
      }
      if (key.type != "numbers") continue;
      const toml::table parsed = toml::parse(line);
      for (const toml::node& item : *parsed.begin()->second.as_array()) {
        const double value = item.value<double>().value_or(0.004);  // "4 mm"
        EXPECT_TRUE(key.limits.holds(value)) << key.path << ": " << line;
        ++lists;
      }
    }
  EXPECT_GT(lists, 10);
  EXPECT_EQ(example_line(*find(methods()[0].keys, "body[].pack.sieves")),
            "sieves = [\"4 mm\", \"8 mm\"]");
}

TEST(Keys, a_prefix_needs_no_brackets_and_no_names) {
  EXPECT_EQ(count("body.pack"), 8U);
  EXPECT_EQ(count("body[].pack"), 8U);
  EXPECT_EQ(count("material.slip"), 4U);
  EXPECT_EQ(count("material.<name>.slip"), 4U);
  EXPECT_EQ(count("slip"), 0U);
}

TEST(Keys, are_found_by_words_of_names_and_meanings) {
  const std::vector<KeyInfo> keys = list_keys<dem::Config>("");
  EXPECT_NE(find(keys_about(keys, "YOUNG"), "material.<name>.young"), nullptr);
  EXPECT_NE(find(keys_about(keys, "gravity acceleration"), "gravity"), nullptr);
  EXPECT_EQ(keys_about(keys, "body.pack").size(), 8U);
  EXPECT_TRUE(keys_about(keys, "supprt").empty());
}

TEST(Keys, the_page_fits_80_columns_and_has_every_key_once_below_its_table) {
  const KeyList keys = all();
  std::istringstream text(keys_for_terminal(keys));
  std::string line;
  std::size_t rows = 0;
  while (std::getline(text, line)) {
    EXPECT_LE(line.size(), 80U) << line;
    EXPECT_FALSE(line.ends_with(' ')) << line;
    rows += line.starts_with("  ") && line[2] != ' ';
  }
  EXPECT_EQ(rows, keys.size());
  EXPECT_EQ(keys.sections[0].methods.size(), 3U);
  EXPECT_GT(keys.sections[0].keys.size(), 30U);
  EXPECT_NE(text.str().find("\n[[body.rebar.bar]]  # "), std::string::npos);
}

TEST(Keys, json_and_markdown_hold_every_key) {
  const KeyList keys = all();
  const std::size_t total = keys.size();
  EXPECT_EQ(parsed_in_order(keys_as_json(keys)).size(), total);
  const std::string page = keys_as_markdown(keys);
  std::size_t rows = 0;
  for (std::size_t at = page.find("\n| `"); at != std::string::npos;
       at = page.find("\n| `", at + 1))
    ++rows;
  EXPECT_EQ(rows, total);
}

/// JSON of TOML's inf, a number that JSON has not.
const Json endless = "Infinity";

/// The first fault of a value under the part of JSON Schema that ours uses; empty: none.
std::string fault(const Json& value, const Json& schema, const std::string& where) {
  for (const char* word : {"oneOf", "anyOf"}) {
    if (!schema.contains(word)) continue;
    std::string first;
    int good = 0;
    for (const Json& option : schema[word])
      if (const std::string f = fault(value, option, where); f.empty())
        ++good;
      else
        first += f + "; ";
    if (good == 0 || (good > 1 && word == std::string("oneOf"))) return "none fits: " + first;
  }
  if (schema.contains("const") && value != schema["const"]) return where + ": another constant";
  if (schema.contains("enum") &&
      std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
    return where + ": " + value.dump() + " is not allowed";
  if (schema.contains("type")) {
    const std::string type = schema["type"];
    const bool fits = type == "object"    ? value.is_object()
                      : type == "array"   ? value.is_array()
                      : type == "string"  ? value.is_string()
                      : type == "integer" ? value.is_number_integer()
                      : type == "number"  ? value.is_number() || value == endless
                                          : value.is_boolean();
    if (!fits) return where + ": is no " + type;
  }
  if (value.is_number()) {
    const double number = value;
    if (number < schema.value("minimum", number) || number > schema.value("maximum", number) ||
        (schema.contains("exclusiveMinimum") && number <= schema["exclusiveMinimum"]) ||
        (schema.contains("exclusiveMaximum") && number >= schema["exclusiveMaximum"]))
      return where + ": out of range";
  }
  if (value.is_string() && schema.contains("pattern") &&
      !matches(value.get<std::string>(), schema["pattern"].get<std::string>()))
    return where + ": another pattern";
  if (value.is_array() && schema.contains("items"))
    for (const Json& item : value)
      if (const std::string f = fault(item, schema["items"], where + "[]"); !f.empty()) return f;
  if (!value.is_object()) return "";
  const Json none = Json::object();
  const Json& known = schema.contains("properties") ? schema["properties"] : none;
  for (const auto& [key, item] : value.items()) {
    const Json* below = known.contains(key) ? &known[key] : nullptr;
    if (below == nullptr && schema.contains("additionalProperties")) {
      if (schema["additionalProperties"] == false) return where + "." + key + ": unknown";
      below = &schema["additionalProperties"];
    }
    if (below == nullptr) continue;
    if (const std::string f = fault(item, *below, where + "." + key); !f.empty()) return f;
  }
  if (schema.contains("required"))
    for (const Json& key : schema["required"])
      if (!value.contains(key.get<std::string>())) return where + ": lacks " + key.dump();
  return "";
}

Json json_of(const std::string& toml) {
  std::stringstream text;
  text << toml::json_formatter{toml::parse(toml)};
  return parsed_in_order(text.str());
}

TEST(KeySchema, every_shipped_case_is_valid_and_slips_are_not) {
  std::vector<MethodKeys> all_methods = methods();
  all_methods.push_back({"dem3d+fdem3d", list_keys<coupled::Config>("")});
  const Json schema = parsed_in_order(key_schema(all_methods));
  std::size_t cases = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::string(source_dir) + "/cases")) {
    if (entry.path().extension() != ".toml") continue;
    ++cases;
    std::stringstream text;
    text << toml::json_formatter{toml::parse_file(entry.path().string())};
    EXPECT_EQ(fault(parsed_in_order(text.str()), schema, ""), "") << entry.path();
  }
  EXPECT_GE(cases, 14U);
  const std::string good = "[time]\nend = \"1 ms\"\n[material.a]\nyoung = 1e9\n";
  EXPECT_EQ(fault(json_of(good), schema, ""), "");
  for (const char* wrong : {"end = \"x\"", "en = 1.0", "end = 1.0\nsafety = 2.0", "end = true"})
    EXPECT_NE(fault(json_of("[time]\n" + std::string(wrong)), schema, ""), "") << wrong;
  EXPECT_NE(fault(json_of(good + "shear = \"plstic\"\n"), schema, ""), "");
  EXPECT_NE(fault(json_of("method = \"fdem2d\"\n[links]\nrange = 1.4\n"), schema, ""), "");
}

}  // namespace key_pages_test
}  // namespace breccia
