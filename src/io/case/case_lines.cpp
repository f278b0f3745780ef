// The lines of a case file that later messages are about.

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

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

/// The line of the deepest part of a key's path that is in the file; 0: none of it is.
std::uint32_t line_of(const toml::table& root, const std::vector<std::string>& path,
                      const std::string& sentence) {
  const toml::table* table = &root;
  std::uint32_t line = 0;
  for (std::size_t k = 0; table != nullptr && k < path.size(); ++k) {
    const toml::node* below = table->get(path[k].substr(0, path[k].find('[')));
    if (below == nullptr) break;
    if (const toml::array* list = below->as_array(); list && list->is_homogeneous<toml::table>()) {
      const std::string name = k + 1 < path.size() ? path[k + 1] : "";
      const std::size_t number = path[k].find('[');  // cut[1]: the second one
      below = number != std::string::npos
                  ? list->get(std::strtoul(path[k].c_str() + number + 1, nullptr, 10))
                  : item_of(*list, name);
      if (below != nullptr && number == std::string::npos)
        ++k;
      else if (below == nullptr)
        below = item_told_of(*list, name, sentence);
      if (below == nullptr) break;
    }
    line = below->source().begin.line;
    table = below->as_table();
  }
  return line;
}

/// Where a word that begins there ends.
std::size_t end_of_word(const std::string& sentence, std::size_t from, const char* ends) {
  return std::min(sentence.find_first_of(ends, std::min(from, sentence.size())), sentence.size());
}

/// The longest name of an item of a list that stands there; names have spaces and dots, too.
std::string name_at(const toml::array& list, const std::string& sentence, std::size_t from) {
  std::string longest;
  for (const toml::node& item : list) {
    const auto name = (*item.as_table())["name"].value_or(std::string());
    const std::size_t end = from + name.size();
    if (name.size() > longest.size() && sentence.compare(from, name.size(), name) == 0 &&
        end_of_word(sentence, end, " .:=,;\n") == end)
      longest = name;
  }
  return longest;
}

/// "body", "the slab", "size" of "body.the slab.size needs ...", "support", "left" of "support left
/// holds ...", "body", "slab", "material" of "body.slab: material = ...".
std::vector<std::string> key_at_start(const toml::table& root, const std::string& sentence) {
  std::vector<std::string> path;
  const toml::table* table = &root;
  const toml::array* list = nullptr;
  for (std::size_t at = 0;;) {
    std::string part = list != nullptr ? name_at(*list, sentence, at) : "";
    if (part.empty()) part = sentence.substr(at, end_of_word(sentence, at, " .:=,;\n") - at);
    if (part.empty()) break;
    path.push_back(part);
    at += part.size();
    const toml::node* below = list != nullptr    ? item_of(*list, part)
                              : table != nullptr ? table->get(part.substr(0, part.find('[')))
                                                 : nullptr;
    table = below != nullptr ? below->as_table() : nullptr;
    list = below != nullptr ? below->as_array() : nullptr;
    if (list != nullptr && !list->is_homogeneous<toml::table>()) list = nullptr;
    const bool goes_on = sentence.substr(at, 1) == ".";
    if (!goes_on && !(path.size() == 1 && below != nullptr && sentence.substr(at, 1) == " ")) {
      const std::size_t begin = at + 2, stop = end_of_word(sentence, begin, " :=,;\n");
      if (sentence.substr(at, 2) == ": " && sentence.substr(stop, 3) == " = ")
        path.push_back(sentence.substr(begin, stop - begin));
      break;
    }
    ++at;
  }
  return path;
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
  name(" with the supports; ", " with the supports of ");
  name(" with the files of the case; ", " with the files of ");
  return told;
}

}  // namespace breccia
