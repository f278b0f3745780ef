#include "io/case/case_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "exec/error.hpp"
#include "io/case/case_overrides.hpp"
#include "io/case/case_source.hpp"
#include "io/case/problems.hpp"
#include "io/case/suggestion.hpp"
#include "io/case/toml_error.hpp"
#include "io/case/units.hpp"
#include "io/case/use_materials.hpp"
#include "io/harmless.hpp"

namespace breccia {
namespace {

const char* type_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

toml::table parse(const std::string& text, const std::string& path) {
  check_case_source(text, path);
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    throw InputError(fmt::format("1 problem in {}; nothing was run.\n  line {}, column {}: {}{}",
                                 path, at.line, at.column, plain_toml_error(error.description()),
                                 excerpt(text, at.line, at.column)));
  }
}

/// In a message a text from the case is one line.
std::string printable(const std::string& text) {
  return harmless(text, "");
}

/// An empty name would stand for all elements where groups are named.
bool is_name(const std::string& name) {
  return !name.empty() && name.front() != ' ' && name.back() != ' ' && printable(name) == name;
}

}  // namespace

struct CaseReader::State {
  struct Level {
    const toml::table* table;
    std::string path;             ///< with a dot behind it; empty at the top
    std::set<std::string> known;  ///< keys that were asked for
    bool in_item;                 ///< at or below an item of a list
  };

  std::string path, content;  ///< of the file, and what is in it
  toml::table root;
  std::vector<Level> levels;
  std::vector<Problem> problems;
  std::vector<std::string> notes;
  inline static const toml::table nothing{};

  Level& top() { return levels.back(); }

  /// The value under a key, or null.
  const toml::node* find(const char* name) {
    top().known.insert(name);
    return top().table->get(name);
  }
  void add(const toml::node* node, const std::string& text, const char* meaning = "") {
    const bool from_file = node != nullptr && node->source().path != nullptr;
    const std::uint32_t line = from_file ? node->source().begin.line : 0;
    problems.push_back({line, (node != nullptr && !from_file ? "--set " : "") + printable(text) +
                                  (*meaning != '\0' ? "\n    " + std::string(meaning) : "")});
  }
  /// Suggestion for the problem noted last, where it stands in the file.
  void correct(const toml::source_region& source, const std::string& old, const std::string& now) {
    if (source.path != nullptr && !now.empty())
      problems.back().correction = {source.begin.line, source.begin.column, old, now};
  }
  void correct(const toml::node& node, const std::string& now) {
    if (const auto text = node.value_exact<std::string>())
      correct(node.source(), "\"" + *text + "\"", now);
  }
  std::string full(const char* name) { return top().path + name; }
  void check_name(const toml::node& node, const char* list, const std::string& name) {
    if (!is_name(name))
      add(&node, fmt::format("{}: \"{}\" cannot be a name; a name is not empty, holds no control "
                             "characters and has no blank at its ends",
                             full(list), name));
  }

  /// A number, or a text with a unit, in SI. False if there is a problem, which is then noted.
  bool quantity(const toml::node& node, const std::string& key, const char* unit, double& value) {
    if (const auto number = node.value_exact<double>()) {
      value = *number;
    } else if (const auto integer = node.value_exact<std::int64_t>()) {
      value = static_cast<double>(*integer);
    } else if (const auto text = node.value_exact<std::string>()) {
      std::string problem, better;
      const double parsed = parse_quantity(*text, unit, problem, &better);
      if (!problem.empty()) {
        add(&node, key + ": " + problem);
        correct(node, better);
        return false;
      }
      value = parsed;
    } else {
      add(&node, fmt::format("{} wants a number in {} or a text with a unit, not {}", key, unit,
                             type_of(node)));
      return false;
    }
    return true;
  }
  bool in_range(const toml::node& node, const std::string& key, double value, double usual,
                const Range& range, const char* meaning, const std::string& unit = "") {
    if (std::isnan(value) || (std::isinf(value) && !std::isinf(usual) &&
                              std::string_view(meaning).find("; inf: ") == std::string::npos)) {
      add(&node, key + " is not a finite number", meaning);
      return false;
    }
    if (range.holds(value)) return true;
    const auto typed = node.value_exact<std::string>();
    std::string text = key + " = " + (typed ? '"' + *typed + '"' : number_text(value)) +
                       " is outside " + range_text(range) + (unit.empty() ? "" : " ") + unit;
    if (!typed) text += meant_with_unit(number_text(value), unit, range);
    add(&node, text, meaning);
    return false;
  }
  bool number(const toml::node& node, const std::string& key, double& to, const char* unit,
              const Range& range, const char* meaning) {
    double given = 0.0;
    const std::string after = *unit == '-' ? "" : unit;
    const Range allowed = given_range(range, unit, to);
    const bool good =
        quantity(node, key, unit, given) && in_range(node, key, given, to, allowed, meaning, after);
    if (good) to = given;
    return good;
  }
  /// As many numbers as there are parts. False if there is a problem, which is then noted.
  template <std::size_t count>
  bool numbers(const toml::node& node, const std::string& key, const std::array<double*, count>& to,
               const char* unit, const Range& range, const char* meaning) {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != count) {
      add(&node, key + (count == 2 ? " wants two numbers, as in [0.0, 1.0]"
                                   : " wants three numbers, as in [0.0, 0.0, 1.0]"));
      return false;
    }
    bool good = true;
    for (std::size_t k = 0; k < count; ++k)
      good =
          number((*array)[k], fmt::format("{}[{}]", key, k), *to[k], unit, range, meaning) && good;
    return good;
  }
  /// A value, or a table [[t, v, ...], ...] over time; it stays as it was if there is a problem.
  template <std::size_t parts, class Value>
  void over_time(const char* name, OverTime<Value>& quantity, const char* unit, const Range& range,
                 const char* meaning) {
    const toml::node* node = find(name);
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array == nullptr || array->empty() || !(*array)[0].is_array())
      return value_at<parts>(*node, full(name), quantity, unit, range, meaning);
    OverTime<Value> given = quantity;
    given.times.assign(array->size(), 0.0);
    given.values.assign(array->size(), Value{});
    const std::size_t before = problems.size();
    for (std::size_t k = 0; k < array->size(); ++k) {
      const toml::node& node_of_row = (*array)[k];
      const toml::array* row = node_of_row.as_array();
      const std::string key = fmt::format("{}[{}]", full(name), k);
      if (row == nullptr || row->size() != parts + 1) {
        add(&node_of_row, fmt::format("{} wants a time and {} number{}, as in {}", key, parts,
                                      parts == 1 ? "" : "s",
                                      parts == 1   ? "[1e-3, 0.5]"
                                      : parts == 2 ? "[1e-3, 0.0, 0.5]"
                                                   : "[1e-3, 0.0, 0.0, 0.5]"));
        continue;
      }
      const std::array<double*, parts> to = parts_of(given.values[k]);
      number((*row)[0], key + "[0]", given.times[k], "s", any_number, "time of the row");
      for (std::size_t p = 0; p < parts; ++p)
        number((*row)[p + 1], fmt::format("{}[{}]", key, p + 1), *to[p], unit, range, meaning);
      if (k > 0 && problems.size() == before && !(given.times[k] > given.times[k - 1]))
        add(&node_of_row,
            fmt::format("{}: its time {} s is not after {} s of the row before; times must grow",
                        key, number_text(given.times[k]), number_text(given.times[k - 1])));
    }
    if (problems.size() == before) quantity = given;
  }
  template <std::size_t parts, class Value>
  void value_at(const toml::node& node, const std::string& key, OverTime<Value>& quantity,
                const char* unit, const Range& range, const char* meaning) {
    OverTime<Value> given(quantity.value);
    const std::array<double*, parts> to = parts_of(given.value);
    bool good = false;
    if constexpr (parts == 1)
      good = number(node, key, *to[0], unit, range, meaning);
    else
      good = numbers<parts>(node, key, to, unit, range, meaning);
    if (good) quantity = given;
  }
  static std::array<double*, 1> parts_of(double& v) { return {&v}; }
  static std::array<double*, 2> parts_of(Vec2& v) { return {&v.x, &v.y}; }
  static std::array<double*, 3> parts_of(Vec3& v) { return {&v.x, &v.y, &v.z}; }

  /// A list, item by item; it stays as it was if there is a problem.
  template <class Item, class Read>
  void list(const char* name, std::vector<Item>& value, const char* example,
            const Read& read_item) {
    const toml::node* node = find(name);
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array == nullptr) return add(node, full(name) + " wants " + example);
    std::vector<Item> given(array->size());
    bool good = true;
    for (std::size_t k = 0; k < given.size(); ++k)
      good = read_item((*array)[k], fmt::format("{}[{}]", full(name), k), given[k]) && good;
    if (good) value = given;
  }
};

CaseReader::CaseReader(const std::string& path, const std::vector<std::string>& overrides)
    : CaseReader(CaseText{read_case_source(case_file_of(path)), case_file_of(path)}, overrides) {}
CaseReader::CaseReader(const CaseText& text, const std::vector<std::string>& overrides)
    : state_(std::make_unique<State>()) {
  state_->path = text.origin;
  state_->content = text.text;
  state_->root = parse(text.text, text.origin);
  for (const std::string& override : overrides) apply_override(state_->root, override);
  use_named_materials(state_->root, state_->problems, state_->notes);
  state_->levels.push_back({&state_->root, "", {}, false});
}
CaseReader::~CaseReader() = default;
const std::vector<std::string>& CaseReader::notes() const {
  return state_->notes;
}

void CaseReader::read(const char* name, double& value, const char* unit, const Range& range,
                      const char* meaning) {
  if (const toml::node* node = state_->find(name))
    state_->number(*node, state_->full(name), value, unit, range, meaning);
}

void CaseReader::read(const char* name, std::int64_t& value, const char*, const Range& range,
                      const char* meaning) {
  const toml::node* node = state_->find(name);
  if (node == nullptr) return;
  const auto integer = node->value_exact<std::int64_t>();
  if (!integer)
    return state_->add(
        node, fmt::format("{} wants an integer, not {}", state_->full(name), type_of(*node)));
  if (state_->in_range(*node, state_->full(name), static_cast<double>(*integer), 0.0, range,
                       meaning))
    value = *integer;
}

void CaseReader::read(const char* name, int& value, const char* unit, const Range& range,
                      const char* meaning) {
  std::int64_t wide = value;
  const Range fits{std::max(range.low, -2147483648.0), std::min(range.high, 2147483647.0),
                   range.open};
  read(name, wide, unit, fits, meaning);
  value = static_cast<int>(wide);
}

void CaseReader::read(const char* name, Vec3& value, const char* unit, const Range& range,
                      const char* meaning) {
  if (const toml::node* node = state_->find(name))
    state_->numbers<3>(*node, state_->full(name), {&value.x, &value.y, &value.z}, unit, range,
                       meaning);
}

void CaseReader::read(const char* name, Vec2& value, const char* unit, const Range& range,
                      const char* meaning) {
  if (const toml::node* node = state_->find(name))
    state_->numbers<2>(*node, state_->full(name), {&value.x, &value.y}, unit, range, meaning);
}

void CaseReader::read(const char* name, OverTime<double>& value, const char* unit,
                      const Range& range, const char* meaning) {
  state_->over_time<1>(name, value, unit, range, meaning);
}
void CaseReader::read(const char* name, OverTime<Vec2>& value, const char* unit, const Range& range,
                      const char* meaning) {
  state_->over_time<2>(name, value, unit, range, meaning);
}
void CaseReader::read(const char* name, OverTime<Vec3>& value, const char* unit, const Range& range,
                      const char* meaning) {
  state_->over_time<3>(name, value, unit, range, meaning);
}

void CaseReader::read(const char* name, std::vector<Vec2>& value, const char* unit,
                      const Range& range, const char* meaning) {
  state_->list(name, value, "points, as in [[0.0, 0.0], [1.0, 0.5]]",
               [&](const toml::node& node, const std::string& key, Vec2& to) {
                 return state_->numbers<2>(node, key, {&to.x, &to.y}, unit, range, meaning);
               });
}

void CaseReader::read(const char* name, std::vector<Vec3>& value, const char* unit,
                      const Range& range, const char* meaning) {
  state_->list(name, value, "points, as in [[0.0, 0.0, 0.0], [1.0, 0.5, 0.0]]",
               [&](const toml::node& node, const std::string& key, Vec3& to) {
                 return state_->numbers<3>(node, key, {&to.x, &to.y, &to.z}, unit, range, meaning);
               });
}

void CaseReader::read(const char* name, std::vector<double>& value, const char* unit,
                      const Range& range, const char* meaning) {
  state_->list(name, value, "a list of numbers, as in [0.0, 1.5]",
               [&](const toml::node& node, const std::string& key, double& to) {
                 return state_->number(node, key, to, unit, range, meaning);
               });
}

void CaseReader::read(const char* name, bool& value, const char*) {
  const toml::node* node = state_->find(name);
  if (node == nullptr) return;
  if (const auto given = node->value_exact<bool>()) return static_cast<void>(value = *given);
  state_->add(node,
              fmt::format("{} wants true or false, not {}", state_->full(name), type_of(*node)));
  if (const auto text = node->value_exact<std::string>(); text == "true" || text == "false")
    state_->correct(*node, *text);
}

void CaseReader::read(const char* name, std::string& value, const char*) {
  const toml::node* node = state_->find(name);
  if (node == nullptr) return;
  if (const auto given = node->value_exact<std::string>())
    value = *given;
  else
    state_->add(node, fmt::format("{} wants a text, not {}", state_->full(name), type_of(*node)));
}

void CaseReader::read(const char* name, std::string& value, const OneOf& words,
                      const char* meaning) {
  std::string given = value;
  read(name, given, meaning);
  const toml::node* node = state_->top().table->get(name);
  if (node == nullptr || !node->is_string()) return;
  if (std::find(words.words.begin(), words.words.end(), given) != words.words.end()) {
    value = given;
    return;
  }
  const std::set<std::string> known(words.words.begin(), words.words.end());
  state_->add(node,
              state_->full(name) + " = \"" + given + "\" is not one of " + words_text(words) +
                  (known.size() > 12 ? suggestion(given, known) : ""),
              meaning);
  if (const std::string meant = nearest(given, known); !meant.empty())
    state_->correct(*node, "\"" + meant + "\"");
}

void CaseReader::read(const char* name, std::vector<std::string>& value, const char*) {
  const toml::node* node = state_->find(name);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  std::vector<std::string> given;
  if (array != nullptr)
    for (const toml::node& item : *array)
      if (const auto text = item.value_exact<std::string>()) given.push_back(*text);
  if (array != nullptr && given.size() == array->size()) {
    value = given;
    return;
  }
  state_->add(node, state_->full(name) + " wants a list of texts, as in [\"x\", \"y\"]");
  if (const auto text = node->value_exact<std::string>())
    state_->correct(*node, "[\"" + *text + "\"]");
}

void CaseReader::require(const char* name) {
  State::Level& level = state_->top();
  if (level.table->contains(name)) return;
  const bool is_item = !level.path.empty() && level.table != &State::nothing;
  state_->add(is_item ? level.table : nullptr,
              level.path + name + " is missing; it has no default");
}

bool CaseReader::enter(const char* name) {
  const toml::node* node = state_->find(name);
  const bool in_item = state_->top().in_item;
  const std::string path = state_->full(name) + ".";
  if (node != nullptr && !node->is_table()) {
    state_->add(node, fmt::format("{} wants a table, not {}", state_->full(name), type_of(*node)));
    node = nullptr;
    return false;
  }
  if (node == nullptr && in_item) return false;
  state_->levels.push_back(
      {node != nullptr ? node->as_table() : &State::nothing, path, {}, in_item});
  return true;
}

std::size_t CaseReader::count(const char* name) {
  const toml::node* node = state_->find(name);
  if (node == nullptr) return 0;
  const toml::array* array = node->as_array();
  if (array == nullptr || (!array->empty() && !array->is_homogeneous<toml::table>())) {
    state_->add(node,
                fmt::format("{0} wants a list of tables, each headed [[{0}]]", state_->full(name)));
    const std::string head = "[" + state_->full(name) + "]";
    if (node->is_table()) state_->correct(node->source(), head, "[" + head + "]");
    return 0;
  }
  std::set<std::string> seen;
  for (const toml::node& item : *array) {
    const auto given = (*item.as_table())["name"].value<std::string>();
    if (given) state_->check_name(item, name, *given);
    if (given && !seen.insert(*given).second)
      state_->add(&item, fmt::format("{} has two items named {}", state_->full(name), *given));
  }
  return array->size();
}

void CaseReader::enter_item(const char* name, std::size_t item) {
  const toml::table* table = state_->top().table->get(name)->as_array()->get(item)->as_table();
  const auto given = (*table)["name"].value<std::string>();
  const std::string path =
      state_->full(name) + (given ? "." + *given : fmt::format("[{}]", item)) + ".";
  state_->levels.push_back({table, path, {}, true});
}

std::vector<std::string> CaseReader::names(const char* name) {
  const toml::node* node = state_->find(name);
  const std::string full_name = state_->full(name);
  std::vector<std::string> names;
  if (node == nullptr) return names;
  const toml::table* table = node->as_table();
  if (table == nullptr) {
    state_->add(node, fmt::format("{0} wants tables, each headed [{0}.NAME]", state_->full(name)));
    return names;
  }
  std::vector<std::pair<std::uint32_t, std::string>> by_line;
  std::set<std::string> stated;
  for (const auto& [key, item] : *table)
    if (item.source().begin.line > 0) stated.insert(std::string(key.str()));
  for (const auto& [key, item] : *table) {
    const std::string word(key.str());
    state_->check_name(item, name, word);
    if (item.is_table() && !stated.contains(word))  // only the path of an override made it
      state_->add(&item, full_name + "." + word + " is not in the case" + suggestion(word, stated));
    else if (item.is_table())
      by_line.emplace_back(item.source().begin.line, word);
    else
      state_->add(&item, fmt::format("{0}.{1} wants a table headed [{0}.{1}]", state_->full(name),
                                     key.str()));
  }
  std::sort(by_line.begin(), by_line.end());
  for (const auto& [line, key] : by_line) names.push_back(key);
  return names;
}

void CaseReader::enter_named(const char* name, const std::string& item) {
  const toml::table* table = state_->top().table->get(name)->as_table()->get(item)->as_table();
  state_->levels.push_back({table, state_->full(name) + "." + item + ".", {}, true});
}

void CaseReader::leave() {
  const State::Level& level = state_->top();
  for (const auto& [key, node] : *level.table)
    if (const std::string word(key.str()); !level.known.contains(word)) {
      state_->add(&node, level.path + word + " is not a key" + suggestion(word, level.known));
      const std::string meant = nearest(word, level.known);
      const toml::node* const there = meant.empty() ? nullptr : level.table->get(meant);
      // One [[suport]] beside a [[support]] becomes one more of them.
      const bool one_more =
          there != nullptr && there->is_array_of_tables() && node.is_array_of_tables();
      if (!meant.empty() && (there == nullptr || one_more))
        state_->correct(key.source(), word, meant);
    }
  state_->levels.pop_back();
}

void CaseReader::finish() {
  leave();
  if (!state_->problems.empty()) throw CaseError(state_->problems, state_->path, state_->content);
}

}  // namespace breccia
