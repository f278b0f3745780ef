// The keys of a case as a table for a terminal.

#include <fmt/format.h>

#include <algorithm>

#include "io/case/case_file.hpp"

namespace breccia {
namespace {

constexpr std::size_t page_width = 100;

/// The words of a text in lines of at most `width` letters, unless a word alone is longer.
std::vector<std::string> lines_of(const std::string& text, std::size_t width) {
  std::vector<std::string> lines{""};
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width)
      lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    at = end + 1;
  }
  return lines;
}

std::string default_with_unit(const KeyInfo& key) {
  const bool has_unit = !key.unit.empty() && key.unit != "-";
  return has_unit ? key.default_text + " " + key.unit : key.default_text;
}

}  // namespace

bool begins_with(const KeyInfo& key, const std::string& prefix) {
  std::string plain = key.path;
  for (const std::string mark : {"[]", ".<name>"})
    for (std::size_t at = plain.find(mark); at != std::string::npos; at = plain.find(mark))
      plain.erase(at, mark.size());
  return key.path.starts_with(prefix) || plain.starts_with(prefix);
}

std::string format_keys(const std::vector<KeyInfo>& keys) {
  std::size_t path = 3, type = 4, usual = 7;  // widths; at least those of the headings
  for (const KeyInfo& key : keys) {
    path = std::max(path, key.path.size());
    type = std::max(type, key.type.size());
    usual = std::max(usual, default_with_unit(key).size());
  }
  const std::size_t before = path + type + usual + 6;
  const auto row = [&](const std::string& a, const std::string& b, const std::string& c,
                       const std::string& d) {
    std::string line = fmt::format("{:<{}}  {:<{}}  {:<{}}  {}", a, path, b, type, c, usual, d);
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
  };
  std::string text = row("key", "type", "default", "allowed");
  for (const KeyInfo& key : keys) {
    const std::size_t rest = before + 20 < page_width ? page_width - before : 20;
    const std::vector<std::string> allowed = lines_of(key.range, rest);
    text += row(key.path, key.type, default_with_unit(key), allowed.front());
    for (std::size_t k = 1; k < allowed.size(); ++k) text += row("", "", "", allowed[k]);
    for (const std::string& line : lines_of(key.meaning, page_width - 4))
      text += "    " + line + "\n";
  }
  return text;
}

}  // namespace breccia
