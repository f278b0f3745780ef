#include "io/case/problems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include "io/harmless.hpp"

namespace breccia {
namespace {

constexpr std::size_t most_of_a_kind = 20, most_told = 200, most_excerpts = 8;
constexpr std::size_t widest_excerpt = 100;  // bytes

/// The common part of problems that differ in their item or value alone: the last part of the key
/// and what follows it, without digits.
std::string kind_of(const std::string& problem) {
  const std::size_t dot = problem.rfind('.', problem.find(' '));
  std::string kind = problem.substr(dot == std::string::npos ? 0 : dot + 1);
  std::erase_if(kind, [](char c) { return c >= '0' && c <= '9'; });
  return kind;
}

}  // namespace

std::string excerpt(const std::string& text, std::uint32_t line, std::uint32_t column) {
  std::size_t begin = 0;
  for (std::uint32_t at = 1; at < line && begin != std::string::npos; ++at) {
    begin = text.find('\n', begin);
    if (begin != std::string::npos) ++begin;
  }
  if (line == 0 || begin >= text.size()) return "";
  std::string shown = text.substr(begin, text.find('\n', begin) - begin);
  while (shown.ends_with('\r') || shown.ends_with(' ')) shown.pop_back();
  if (shown.size() > widest_excerpt) return "";
  shown = fmt::format("\n    {:>4} | {}", line, harmless(shown, "\t"));
  if (column > 0) shown += fmt::format("\n         | {:>{}}", '^', column);
  return shown;
}

std::string problems_text(std::vector<Problem> problems, const std::string& where,
                          const std::string& text) {
  std::stable_sort(problems.begin(), problems.end(),
                   [](const Problem& a, const Problem& b) { return a.line < b.line; });
  std::string told_text = fmt::format("{} problem{} in {}; nothing was run.", problems.size(),
                                      problems.size() == 1 ? "" : "s", where);
  std::map<std::string, std::size_t> of_kind;
  std::size_t told = 0;
  for (const Problem& problem : problems) {
    if (told == most_told || ++of_kind[kind_of(problem.text)] > most_of_a_kind) continue;
    ++told;
    told_text +=
        "\n  " + (problem.line > 0 ? fmt::format("line {}, ", problem.line) : "") + problem.text;
    if (problems.size() <= most_excerpts) told_text += excerpt(text, problem.line);
  }
  if (told < problems.size())
    told_text += fmt::format("\n  ... and {} more like these", problems.size() - told);
  return told_text;
}

CaseError::CaseError(std::vector<Problem> all, const std::string& where, const std::string& text)
    : InputError(problems_text(all, where, text)), problems(std::move(all)) {}

namespace {

/// The byte at which a column begins: columns count letters.
std::size_t byte_of(std::string_view line, std::uint32_t column) {
  std::size_t at = 0;
  for (std::uint32_t k = 1; k < column && at < line.size(); ++k) do
      ++at;
    while (at < line.size() && (static_cast<unsigned char>(line[at]) & 0xC0U) == 0x80U);
  return at;
}

void apply(std::vector<std::string>& lines, const Correction& c) {
  if (c.line == 0 || c.line > lines.size()) return;
  std::string& line = lines[c.line - 1];
  std::string old = c.old;
  std::size_t at = line.find(old, byte_of(line, c.column));
  if (at == std::string::npos && old.size() > 1 && old.front() == '"') {  // TOML has two quotes
    old.front() = old.back() = '\'';
    at = line.find(old, byte_of(line, c.column));
  }
  if (at != std::string::npos) line.replace(at, old.size(), c.now);
}

}  // namespace

std::string corrected(const std::string& text, const std::vector<Problem>& problems) {
  std::vector<std::string> lines(1);
  for (const char c : text)
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  std::vector<Correction> all;
  for (const Problem& problem : problems)
    if (problem.correction) all.push_back(*problem.correction);
  std::stable_sort(all.begin(), all.end(), [](const Correction& a, const Correction& b) {
    return std::pair(a.line, a.column) > std::pair(b.line, b.column);
  });
  for (const Correction& c : all) apply(lines, c);
  std::string result;
  for (std::size_t k = 0; k < lines.size(); ++k) result += (k > 0 ? "\n" : "") + lines[k];
  return result;
}

}  // namespace breccia
