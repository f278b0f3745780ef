// The lines of a case file that later messages are about.

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "io/case/case_file.hpp"
#include "io/case/case_source.hpp"
#include "io/case/problems.hpp"
#include "io/case/toml.hpp"

namespace breccia {
namespace {

/// The item of a list of tables that has a name; null: none.
const toml::node* item_of(const toml::array& list, const std::string& name) {
  for (const toml::node& item : list)
    if ((*item.as_table())["name"].value_or(std::string()) == name) return &item;
  return nullptr;
}

/// The item of a list that has a text under a key, and a sentence names it between quotation marks;
/// null: none.
const toml::node* item_told_of(const toml::array& list, const std::string& key,
                               const std::string& sentence) {
  for (const toml::node& item : list)
    if (const auto text = (*item.as_table())[key].value<std::string>();
        text && sentence.find('"' + *text + '"') != std::string::npos)
      return &item;
  return nullptr;
}

/// The part of a key's path up to its first dot, and the rest.
std::pair<std::string, std::string> parted(const std::string& path) {
  const std::size_t dot = std::min(path.find('.'), path.size());
  return {path.substr(0, dot), path.substr(std::min(dot + 1, path.size()))};
}

/// The line of the deepest part of a key's path that is in the file; 0: none of it is.
std::uint32_t line_of(const toml::table& root, const std::string& path,
                      const std::string& sentence) {
  const toml::table* table = &root;
  std::uint32_t line = 0;
  for (auto [part, rest] = parted(path); table != nullptr && !part.empty();
       std::tie(part, rest) = parted(rest)) {
    const toml::node* below = table->get(part.substr(0, part.find('[')));
    if (below == nullptr) break;
    if (const toml::array* list = below->as_array(); list && list->is_homogeneous<toml::table>()) {
      std::tie(part, rest) = parted(rest);
      below = item_of(*list, part);
      if (below == nullptr && (below = item_told_of(*list, part, sentence)) != nullptr)
        rest = rest.empty() ? part : part + "." + rest;
      if (below == nullptr) break;
    }
    line = below->source().begin.line;
    table = below->as_table();
  }
  return line;
}

/// "body.slab.size" of "body.slab.size needs ...", "support.left" of "support left holds ...",
/// "body.slab.material" of "body.slab: material = ...".
std::string key_at_start(const toml::table& root, const std::string& sentence) {
  const auto end_of_word = [&](std::size_t from) {
    return std::min(sentence.find_first_of(" :=,;\n", from), sentence.size());
  };
  const std::size_t end = end_of_word(0);
  std::string key = sentence.substr(0, end);
  if (key.find('.') == std::string::npos && root.contains(key) && sentence.substr(end, 1) == " ")
    key += "." + sentence.substr(end + 1, end_of_word(end + 1) - end - 1);
  while (key.ends_with('.')) key.pop_back();
  const std::size_t begin = end + 2, stop = end_of_word(std::min(begin, sentence.size()));
  if (sentence.substr(end, 2) == ": " && sentence.substr(stop, 3) == " = ")
    key += "." + sentence.substr(begin, stop - begin);
  return key;
}

}  // namespace

std::uint32_t line_of_sentence(const std::string& sentence, const std::string& path) {
  try {
    const toml::table root = toml::parse_file(case_file_of(path));
    return line_of(root, key_at_start(root, sentence), sentence);
  } catch (const toml::parse_error&) {
    return 0;  // its reader tells
  }
}

std::string with_lines(const std::string& message, const std::string& path) {
  const std::string file = case_file_of(path);
  std::string text;
  toml::table root;
  try {
    text = read_case_source(file);
    root = toml::parse(text, file);
  } catch (const toml::parse_error&) {
    return message;  // its reader tells
  }
  const auto line_text = [&](const std::string& sentence) {
    const std::uint32_t line = line_of(root, key_at_start(root, sentence), sentence);
    return line > 0 ? fmt::format("line {}, ", line) : std::string();
  };
  const std::string alone = line_text(message);  // a sentence without a heading
  std::string told = alone.empty() ? "" : file + ": " + alone;
  for (std::size_t at = 0; at < message.size();) {
    const std::size_t end = std::min(message.find('\n', at), message.size() - 1) + 1;
    const std::string line = message.substr(at, end - at);
    const bool item = line.starts_with("  ") && line.find_first_not_of(' ') == 2;
    if (!item) {
      told += line;
    } else {
      const std::string sentence = line.substr(2, line.find('\n') - 2);
      told += "  " + line_text(sentence) + sentence;
      told += excerpt(text, line_of(root, key_at_start(root, sentence), sentence));
      if (line.ends_with('\n')) told += '\n';
    }
    at = end;
  }
  const auto name = [&](const std::string& heading, const std::string& now) {
    if (const std::size_t at = told.find(heading); at < told.find('\n'))
      told.replace(at, heading.size(), now + file + "; ");
  };
  name(" in the case; ", " in ");
  name(" with the model; ", " with the model of ");
  name(" with the files of the case; ", " with the files of ");
  return told;
}

}  // namespace breccia
