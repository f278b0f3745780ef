// JSON Schema of case files.

#include <sstream>

#include "io/case/key_pages.hpp"
#include "io/json.hpp"

namespace breccia {
namespace {

void add_limits(Json& json, const Range& limits) {
  const bool open_low = limits.open == Open::low || limits.open == Open::both;
  const bool open_high = limits.open == Open::high || limits.open == Open::both;
  if (limits.low > -no_limit) json[open_low ? "exclusiveMinimum" : "minimum"] = limits.low;
  if (limits.high < no_limit) json[open_high ? "exclusiveMaximum" : "maximum"] = limits.high;
}

/// A number in SI units, or a text with a unit.
Json number(const KeyInfo& key) {
  Json plain{{"type", "number"}};
  add_limits(plain, key.limits);
  const Json typed{{"type", "string"}, {"pattern", "^ *[-+]?[0-9.].* *$"}};
  return {{"anyOf", Json::array({plain, typed})}};
}

Json array_of(const Json& items, std::size_t count) {
  Json json{{"type", "array"}, {"items", items}};
  if (count > 0) json["minItems"] = json["maxItems"] = count;
  return json;
}

Json type_of(const KeyInfo& key) {
  if (const std::size_t at = key.type.find(" or table"); at != std::string::npos) {
    KeyInfo one = key;
    one.type = key.type.substr(0, at);
    const Json row{{"type", "array"}, {"minItems", 2}};  // a time and a value
    return {{"anyOf", Json::array({type_of(one), array_of(row, 0)})}};
  }
  if (key.type == "number") return number(key);
  if (key.type == "integer") {
    Json json{{"type", "integer"}};
    add_limits(json, key.limits);
    return json;
  }
  if (key.type == "3 numbers") return array_of(number(key), 3);
  if (key.type == "2 numbers") return array_of(number(key), 2);
  if (key.type == "numbers") return array_of(number(key), 0);
  if (key.type == "points") return array_of(array_of(number(key), 2), 0);
  if (key.type == "points in space") return array_of(array_of(number(key), 3), 0);
  if (key.type == "true/false") return {{"type", "boolean"}};
  if (key.type == "texts") return array_of({{"type", "string"}}, 0);
  Json json{{"type", "string"}};
  if (key.type == "word") {
    std::istringstream words(key.range);
    for (std::string word; words >> word;)
      if (word != "|") json["enum"].push_back(word);
  }
  return json;
}

Json of_key(const KeyInfo& key) {
  Json json = type_of(key);
  json["description"] =
      (key.unit.empty() || key.unit == "-" ? "" : "[" + key.unit + "] ") + key.meaning;
  if (key.default_text != "(required)")
    if (const Json usual = read_json(key.default_text); !usual.is_discarded())
      json["default"] = usual;
  return json;
}

Json table() {
  return {{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
}

/// Puts a key below the tables that its path names.
void insert(Json& root, const KeyInfo& key) {
  Json* at = &root;
  std::string rest = key.path;
  for (std::size_t dot = rest.find('.'); dot != std::string::npos; dot = rest.find('.')) {
    std::string part = rest.substr(0, dot);
    rest = rest.substr(dot + 1);
    const bool list = part.ends_with("[]");
    if (list) part.resize(part.size() - 2);
    if (part == "<name>") {
      Json& any = (*at)["additionalProperties"];
      if (!any.is_object()) any = table();
      at = &any;
      continue;
    }
    Json& below = (*at)["properties"][part];
    if (below.is_null()) {
      below = list ? array_of(table(), 0) : table();
      const bool named = rest.starts_with("<name>");
      if (!named && !key.table_meaning.empty() && rest.find('.') == std::string::npos)
        below["description"] = key.table_meaning;
    }
    at = list ? &below["items"] : &below;
  }
  (*at)["properties"][rest] = of_key(key);
  if (key.default_text == "(required)") (*at)["required"].push_back(rest);
}

Json schema_of(const std::vector<KeyInfo>& keys, const std::string& method, bool is_default) {
  Json json = table();
  for (const KeyInfo& key : keys) insert(json, key);
  Json word = method;
  if (const std::size_t plus = method.find('+'); plus != std::string::npos)  // two in one run
    word = Json::array({method.substr(0, plus), method.substr(plus + 1)});
  json["properties"]["method"] = {{"const", word}, {"description", "which method runs the case"}};
  if (!is_default) json["required"].push_back("method");
  return json;
}

}  // namespace

std::string key_schema(const std::vector<MethodKeys>& methods) {
  Json options = Json::array();
  for (const MethodKeys& m : methods)
    options.push_back(schema_of(m.keys, m.method, options.empty()));
  const Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
                    {"title", "A case of Breccia"},
                    {"oneOf", options}};
  return json_text(schema, 1) + "\n";
}

}  // namespace breccia
