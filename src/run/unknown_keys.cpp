#include "run/unknown_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"
#include "io/case/case_file.hpp"
#include "io/case/key_pages.hpp"
#include "run/case_keys.hpp"

namespace breccia {
namespace {

/// Tables that a method lacks, and what it has in their place (docs/stages.md).
struct Instead {
  const char *method, *table, *sentence;
};
constexpr Instead instead[] = {
    {"dem3d", "load",
     "spheres have no faces: walls and supports with a servo press, `force` of a [[support]] acts "
     "on elements, `absorb` takes waves up"},
    {"dem3d", "in_situ", "a packing is put under stress by servos, in a first stage"},
    {"dem3d", "bolt", "bars with bond are bodies of shape \"rebar\""},
    {"dem3d", "joint_set", "[[body.cut]] parts links, one cut at a time"},
    {"dem3d", "discontinuity", "[[body.cut]] parts links"},
    {"fdem2d", "wall", "a body that a [[support]] holds as a whole is rigid"},
    {"fdem3d", "wall", "a body that a [[support]] holds as a whole is rigid"},
    {"fdem3d", "contact", "faces of tetrahedra lose energy by friction and `damping`"},
};

/// Whether a method has a key or table: its first word as the first one, its last word as any.
bool has_key(const std::vector<KeyInfo>& keys, const std::string& path) {
  const std::string first = path.substr(0, path.find('.')), last = path.substr(path.rfind('.') + 1);
  return std::any_of(keys.begin(), keys.end(), [&](const KeyInfo& key) {
    if (key.path.substr(0, key.path.find_first_of(".[")) != first) return false;
    const std::string inside = key.path + ".";
    return first == path || inside.find("." + last + ".") != std::string::npos ||
           inside.find("." + last + "[") != std::string::npos;
  });
}

std::vector<KeyInfo> keys_of(const std::string& method) {
  return method == "fdem2d"   ? list_keys<fdem::Config>("")
         : method == "fdem3d" ? list_keys<fdem3::Config>("")
                              : list_keys<dem::Config>("");
}

/// Of a word without a table that is a key of some: which.
Problem told_of_tables(Problem problem, const std::string& method) {
  static const std::string unknown = " is not a key", set = "--set ";
  const std::size_t begin = problem.text.starts_with(set) ? set.size() : 0;
  const std::size_t end = problem.text.find(unknown);
  if (end == std::string::npos || end + unknown.size() != problem.text.size()) return problem;
  const std::string word = problem.text.substr(begin, end - begin);
  if (word.find_first_of(" .[=\"") != std::string::npos) return problem;
  std::vector<std::string> tables;
  for (const KeyInfo& key : keys_of(method))
    if (key.path.ends_with("." + word)) tables.push_back(table_heading(key));
  constexpr std::size_t most = 3;
  if (tables.empty() || tables.size() > most) return problem;
  problem.text +=
      fmt::format("; {} {} it", fmt::join(tables, " and "), tables.size() > 1 ? "have" : "has");
  return problem;
}

/// The words of a path, "body[0].pack" or "body[].pack": body, 0 or nothing, pack.
std::vector<std::string> words_of(const std::string& path) {
  std::vector<std::string> words(1);
  for (const char c : path) {
    if (c == '.' || c == '[')
      words.emplace_back();
    else if (c != ']')
      words.back() += c;
  }
  return words;
}

/// Of an unknown key that a table within its table has: which.
Problem told_of_inner(Problem problem, const std::string& method) {
  static const std::string unknown = " is not a key", set = "--set ";
  const std::size_t begin = problem.text.starts_with(set) ? set.size() : 0;
  const std::size_t end = problem.text.find(unknown);
  const std::string path = problem.text.substr(begin, end - begin);
  if (end == std::string::npos || path.find_first_of(" =\"") != std::string::npos) return problem;
  const std::vector<std::string> words = words_of(path);
  if (words.size() < 2) return problem;
  const std::string above = path.substr(0, path.rfind('.') + 1);
  std::vector<std::string> tables;
  for (const KeyInfo& key : keys_of(method)) {
    const std::vector<std::string> own = words_of(key.path);
    if (own.size() != words.size() + 1 || own.back() != words.back()) continue;
    bool within = true;
    for (std::size_t k = 0; k + 1 < words.size(); ++k)
      within &= own[k] == words[k] || own[k].empty() || own[k] == "<name>";
    const std::string& table = own[own.size() - 2];
    if (within && !table.empty() && table != "<name>") tables.push_back(above + table);
  }
  if (tables.empty()) return problem;
  problem.correction.reset();
  problem.text = fmt::format("{}{}; it belongs in {}", problem.text.substr(0, end), unknown,
                             fmt::join(tables, " or "));
  return problem;
}

/// Of an unknown key that other methods have: which, and what this one has in its place.
Problem told_of_others(Problem problem, const std::string& method) {
  static const std::string unknown = " is not a key";
  const std::size_t end = problem.text.find(unknown);
  const std::string path = problem.text.substr(0, end);
  if (end == std::string::npos || path.find_first_of(" =\"") != std::string::npos) return problem;
  std::vector<std::string> others;
  bool elsewhere = false;  // the method has the word, in another table
  const auto ask = [&](const char* other, const std::vector<KeyInfo>& keys) {
    if (!has_key(keys, path)) return;
    if (other == method)
      elsewhere = true;
    else
      others.emplace_back(other);
  };
  ask("dem3d", list_keys<dem::Config>(""));
  ask("fdem2d", list_keys<fdem::Config>(""));
  ask("fdem3d", list_keys<fdem3::Config>(""));
  if (elsewhere || others.empty()) return problem;
  problem.correction.reset();
  problem.text = fmt::format("{}{} of {}; {} {} it", path, unknown, method,
                             fmt::join(others, " and "), others.size() > 1 ? "have" : "has");
  for (const Instead& i : instead)
    if (method == i.method && path == i.table) problem.text += fmt::format("\n    {}", i.sentence);
  return problem;
}

}  // namespace

Problem told_of_unknown(Problem problem, const std::string& method) {
  return told_of_inner(told_of_tables(told_of_others(std::move(problem), method), method), method);
}

}  // namespace breccia
