#include "io/case/problems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace breccia {
namespace {

constexpr std::size_t most_of_a_kind = 20, most_told = 200;

/// The common part of problems that differ in their item or value alone: the last part of the key
/// and what follows it, without digits.
std::string kind_of(const std::string& problem) {
  const std::size_t dot = problem.rfind('.', problem.find(' '));
  std::string kind = problem.substr(dot == std::string::npos ? 0 : dot + 1);
  std::erase_if(kind, [](char c) { return c >= '0' && c <= '9'; });
  return kind;
}

}  // namespace

std::string problems_text(std::vector<Problem> problems, const std::string& where) {
  std::stable_sort(problems.begin(), problems.end(),
                   [](const Problem& a, const Problem& b) { return a.line < b.line; });
  std::string text = fmt::format("{} problem{} in {}; nothing was run.", problems.size(),
                                 problems.size() == 1 ? "" : "s", where);
  std::map<std::string, std::size_t> of_kind;
  std::size_t told = 0;
  for (const Problem& problem : problems) {
    if (told == most_told || ++of_kind[kind_of(problem.text)] > most_of_a_kind) continue;
    ++told;
    text +=
        "\n  " + (problem.line > 0 ? fmt::format("line {}, ", problem.line) : "") + problem.text;
  }
  if (told < problems.size())
    text += fmt::format("\n  ... and {} more like these", problems.size() - told);
  return text;
}

}  // namespace breccia
