#include "io/case/key_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "io/json.hpp"
#include "math/constants.hpp"

namespace breccia {
namespace {

constexpr std::size_t page_width = 80;

bool alike(const KeyInfo& a, const KeyInfo& b) {
  return a.path == b.path && a.type == b.type && a.unit == b.unit &&
         a.default_text == b.default_text && a.range == b.range && a.meaning == b.meaning;
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Paths without [] and .<name>.
std::string plain_path(const KeyInfo& key) {
  std::string plain = key.path;
  for (const std::string mark : {"[]", ".<name>"})
    for (std::size_t at = plain.find(mark); at != std::string::npos; at = plain.find(mark))
      plain.erase(at, mark.size());
  return plain;
}

std::string last_part(const KeyInfo& key) {
  return key.path.substr(key.path.rfind('.') + 1);
}

/// "30 GPa" of 3e10 and "Pa"; empty if a plain number says it best.
std::string with_unit(double value, const std::string& unit) {
  struct Scaled {
    const char *unit, *shown;
    double factor;
  };
  static const std::vector<Scaled> scales{
      {"Pa", "GPa", 1e9},      {"Pa", "MPa", 1e6},    {"Pa", "kPa", 1e3},
      {"m", "m", 1.0},         {"m", "mm", 1e-3},     {"s", "s", 1.0},
      {"s", "ms", 1e-3},       {"s", "us", 1e-6},     {"rad", "deg", pi / 180.0},
      {"kg/m3", "kg/m3", 1.0}, {"J/m2", "J/m2", 1.0}, {"m/s", "m/s", 1.0},
      {"m/s2", "m/s2", 1.0},   {"N/m", "N/m", 1.0}};
  for (const Scaled& scale : scales)
    if (unit == scale.unit && std::abs(value) >= 0.999 * scale.factor)
      return fmt::format("\"{:.6g} {}\"", value / scale.factor, scale.shown);
  return "";
}

std::string example_value(const KeyInfo& key) {
  const bool required = key.default_text == "(required)";
  const bool has_unit = !key.unit.empty() && key.unit != "-";
  if (key.type == "text") return required ? "\"...\"" : key.default_text;
  if (key.type == "3 numbers" && key.default_text.find("inf") == std::string::npos)
    return key.unit == "m" ? "[0.0, \"5 mm\", 0.1]" : key.default_text;
  if (key.type == "2 numbers" && key.default_text.find("inf") == std::string::npos)
    return key.unit == "m" ? "[0.0, \"5 mm\"]" : key.default_text;
  if (key.type == "points") return "[[0.0, 0.0], [\"10 mm\", 0.2]]";
  if (key.type == "points in space") return "[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]";
  if (key.type == "numbers" && !key.limits.holds(0.0))
    return key.unit == "m" ? "[\"4 mm\", \"8 mm\"]" : "[1.0, 2.0]";
  if (key.type == "numbers") return "[0.0, 1.0]";
  if (key.type == "number") {
    double value = 0.0;
    const std::string& text = key.default_text;
    std::from_chars(text.data(), text.data() + text.size(), value);
    if (required) return has_unit ? "\"... " + key.unit + "\"" : "...";
    if (has_unit && value != 0.0)
      if (const std::string typed = with_unit(value, key.unit); !typed.empty()) return typed;
    return fmt::format("{:.6g}", value);
  }
  return required ? "..." : key.default_text;
}

/// Keys in the order of their tables.
template <class Visit>
void each_table(const std::vector<KeyInfo>& keys, const Visit& visit) {
  std::vector<std::string> done;
  for (const KeyInfo& first : keys) {
    const std::string heading = table_heading(first);
    if (std::find(done.begin(), done.end(), heading) != done.end()) continue;
    done.push_back(heading);
    std::vector<KeyInfo> own;
    for (const KeyInfo& key : keys)
      if (table_heading(key) == heading) own.push_back(key);
    visit(heading, first.table_meaning, own);
  }
}

void add_lines(std::string& text, const std::string& sentence, std::size_t indent) {
  for (const std::string& line : wrapped(sentence, page_width - indent))
    text += std::string(indent, ' ') + line + "\n";
}

std::string allowed_text(const KeyInfo& key) {
  if (key.range.empty() || key.range == "any") return "";
  const bool in_si = key.unit != "-" && key.type != "word" && !key.unit.empty();
  return key.range + (in_si ? " " + key.unit : "");
}

std::string section(const std::string& title, const std::vector<KeyInfo>& keys) {
  if (keys.empty()) return "";
  std::string text = "# " + title + "\n";
  each_table(keys, [&](const std::string& heading, const std::string& meaning,
                       const std::vector<KeyInfo>& own) {
    text += "\n";
    if (heading.empty())
      text += "at the top of the file\n";
    else if (heading.size() + meaning.size() + 4 <= page_width)
      text += heading + "  # " + meaning + "\n";
    else
      for (const std::string& line : wrapped(meaning, page_width - 2)) text += "# " + line + "\n";
    if (heading.size() + meaning.size() + 4 > page_width) text += heading + "\n";
    for (const KeyInfo& key : own) {
      text += "  " + example_line(key);
      const std::string allowed = allowed_text(key);
      const std::size_t used = text.size() - text.rfind('\n') - 1;
      const bool beside = !allowed.empty() && used + allowed.size() + 4 <= page_width;
      text += beside ? "  # " + allowed + "\n" : "\n";
      if (!allowed.empty() && !beside) add_lines(text, "one of: " + allowed, 6);
      add_lines(text, (key.default_text == "(required)" ? "(required) " : "") + key.meaning, 6);
    }
  });
  return text;
}

Json as_json(const KeyInfo& key, const std::vector<std::string>& methods) {
  Json json;
  json["path"] = key.path;
  json["methods"] = methods;
  json["table"] = table_heading(key);
  json["type"] = key.type;
  json["unit"] = key.unit;
  json["required"] = key.default_text == "(required)";
  if (key.default_text != "(required)") json["default"] = key.default_text;
  json["allowed"] = key.range;
  json["meaning"] = key.meaning;
  json["example"] = example_line(key);
  return json;
}

/// "method = "fdem2d" or "fdem3d"".
std::string title_of(const std::vector<std::string>& methods) {
  std::string title;
  for (const std::string& method : methods)
    title += (title.empty() ? "method = \"" : " or \"") + method + '"';
  return title;
}

}  // namespace

std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
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

bool begins_with(const KeyInfo& key, const std::string& prefix) {
  return key.path.starts_with(prefix) || plain_path(key).starts_with(prefix);
}

std::size_t KeyList::size() const {
  std::size_t count = 0;
  for (const Section& section : sections) count += section.keys.size();
  return count;
}

KeyList key_list(const std::vector<MethodKeys>& methods) {
  KeyList list;
  const auto has = [](const MethodKeys& m, const KeyInfo& key) {
    return std::any_of(m.keys.begin(), m.keys.end(),
                       [&](const KeyInfo& k) { return alike(k, key); });
  };
  for (std::size_t m = 0; m < methods.size(); ++m)
    for (const KeyInfo& key : methods[m].keys) {
      std::vector<std::string> of;
      bool listed = false;
      for (std::size_t other = 0; other < methods.size(); ++other) {
        if (!has(methods[other], key)) continue;
        listed = listed || other < m;
        of.push_back(methods[other].method);
      }
      if (listed) continue;
      const auto found =
          std::find_if(list.sections.begin(), list.sections.end(),
                       [&](const KeyList::Section& section) { return section.methods == of; });
      if (found == list.sections.end())
        list.sections.push_back({of, {key}});
      else
        found->keys.push_back(key);
    }
  std::stable_sort(list.sections.begin(), list.sections.end(), [](const auto& a, const auto& b) {
    return a.methods.size() > b.methods.size();
  });
  return list;
}

std::vector<KeyInfo> keys_about(const std::vector<KeyInfo>& keys, const std::string& words) {
  std::vector<KeyInfo> found;
  for (const KeyInfo& key : keys)
    if (begins_with(key, words)) found.push_back(key);
  if (!found.empty()) return found;
  for (const KeyInfo& key : keys) {
    const std::string text = lower(key.path + " " + key.meaning + " " + key.range);
    std::istringstream stream(lower(words));
    bool all = true;
    for (std::string word; stream >> word;) all = all && text.find(word) != std::string::npos;
    if (all) found.push_back(key);
  }
  const std::size_t first = words.find('.'), second = words.find('.', first + 1);
  if (!found.empty() || first == std::string::npos || second == std::string::npos) return found;
  return keys_about(keys, words.substr(0, first) + words.substr(second));  // an item's own name
}

std::vector<KeyInfo> keys_about_each(const std::vector<KeyInfo>& keys, const std::string& words) {
  std::vector<KeyInfo> found;
  std::set<std::string> paths;
  std::istringstream stream(words);
  for (std::string word; stream >> word;)
    for (const KeyInfo& key : keys_about(keys, word))
      if (paths.insert(key.path).second) found.push_back(key);
  return found;
}

std::string table_heading(const KeyInfo& key) {
  const std::size_t dot = key.path.rfind('.');
  if (dot == std::string::npos) return "";
  std::string table = key.path.substr(0, dot);
  const bool list = table.ends_with("[]");
  for (std::size_t at = table.find("[]"); at != std::string::npos; at = table.find("[]"))
    table.erase(at, 2);
  for (std::size_t at = table.find("<name>"); at != std::string::npos; at = table.find("<name>"))
    table.replace(at, 6, "NAME");
  return list ? "[[" + table + "]]" : "[" + table + "]";
}

std::string example_line(const KeyInfo& key) {
  return last_part(key) + " = " + example_value(key);
}

std::string keys_for_terminal(const KeyList& keys) {
  std::string text;
  for (const KeyList::Section& each : keys.sections)
    if (const std::string part = section(title_of(each.methods), each.keys); !part.empty())
      text += (text.empty() ? "" : "\n") + part;
  return text;
}

std::string keys_as_markdown(const KeyList& keys) {
  std::string text = "# Keys of case files\n";
  const auto cell = [](std::string words) {
    for (std::size_t at = words.find('|'); at != std::string::npos; at = words.find('|', at + 2))
      words.replace(at, 1, "\\|");
    return words;
  };
  for (const KeyList::Section& each : keys.sections) {
    text += fmt::format("\n## {}\n", fmt::join(each.methods, ", "));
    each_table(each.keys, [&](const std::string& heading, const std::string& meaning,
                              const std::vector<KeyInfo>& rows) {
      text += heading.empty() ? "\n### At the top of the file\n"
                              : fmt::format("\n### `{}`: {}\n", heading, meaning);
      text += "\n| key | type | allowed | meaning |\n|---|---|---|---|\n";
      for (const KeyInfo& key : rows)
        text += fmt::format("| `{}`{} | {} | {} | {} |\n", example_line(key),
                            key.default_text == "(required)" ? " (required)" : "", key.type,
                            cell(allowed_text(key)), cell(key.meaning));
    });
  }
  return text;
}

std::string keys_as_json(const KeyList& keys) {
  Json all = Json::array();
  for (const KeyList::Section& section : keys.sections)
    for (const KeyInfo& key : section.keys) all.push_back(as_json(key, section.methods));
  return json_text(all, 1) + "\n";
}

}  // namespace breccia
