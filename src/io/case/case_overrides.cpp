#include "io/case/case_overrides.hpp"

#include <algorithm>
#include <charconv>

#include "exec/error.hpp"
#include "io/case/case_file.hpp"
#include "io/case/case_source.hpp"
#include "io/case/toml_error.hpp"

namespace breccia {
namespace {

/// The value of an override: TOML if it is, else the text itself.
void insert_value(toml::table& table, const std::string& key, const std::string& text) {
  try {
    toml::table parsed = toml::parse("value = " + text);
    if (parsed.size() == 1) {
      parsed["value"].visit([&](auto& node) { table.insert_or_assign(key, std::move(node)); });
      return;
    }
  } catch (const toml::parse_error&) {
  }
  try {
    static_cast<void>(toml::parse("value = " + value_text(text)));
  } catch (const toml::parse_error& error) {
    throw InputError("--set " + key + ": " + plain_toml_error(error.description()) +
                     "; nothing was run.");
  }
  table.insert_or_assign(key, text);
}

toml::table* item_of(toml::array& list, const std::string& name) {
  for (toml::node& node : list)
    if (toml::table* table = node.as_table();
        table && (*table)["name"].value_or(std::string()) == name)
      return table;
  std::size_t number = 0;
  const auto parsed = std::from_chars(name.data(), name.data() + name.size(), number);
  if (parsed.ec == std::errc{} && parsed.ptr == name.data() + name.size() && number < list.size())
    return list[number].as_table();
  return nullptr;
}

}  // namespace

void apply_override(toml::table& root, const std::string& text) {
  check_case_source(text, "--set");
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("--set " + text + " is not of the form KEY=VALUE; nothing was run.");
  std::string rest = text.substr(0, equals);
  toml::table* table = &root;
  for (std::size_t dot = rest.find('.'); dot != std::string::npos; dot = rest.find('.')) {
    const std::string part = rest.substr(0, dot);
    rest = rest.substr(dot + 1);
    toml::node* below = table->get(part);
    if (below == nullptr) {
      table->insert(part, toml::table{});
      below = table->get(part);
    }
    if (toml::array* list = below->as_array()) {
      const std::size_t next = std::min(rest.find('.'), rest.size());
      table = item_of(*list, rest.substr(0, next));
      if (table != nullptr && next == rest.size())
        throw InputError("--set " + text + " sets a whole item; name one of its keys, as in " +
                         part + "." + rest + ".KEY=VALUE; nothing was run.");
      if (table == nullptr)
        throw InputError("--set " + text + ": " + part + " has no item '" + rest.substr(0, next) +
                         "'; name one of its items, or give its number from 0; nothing was run.");
      rest = rest.substr(next + 1);
    } else if (!(table = below->as_table())) {
      throw InputError("--set " + text + ": " + part + " has no keys below it; nothing was run.");
    }
  }
  insert_value(*table, rest, text.substr(equals + 1));
}

}  // namespace breccia
