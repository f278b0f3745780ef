#include "io/case/case_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "exec/error.hpp"
#include "io/case/case_file.hpp"
#include "io/whole_file.hpp"

namespace breccia {
namespace {

constexpr std::size_t largest_file = std::size_t{16} << 20;  // bytes
constexpr std::size_t longest_line = std::size_t{1} << 20;   // bytes
constexpr std::size_t deepest_key = 16;                      // parts
constexpr const char* too_large =
    "it is larger than 16 MiB; many spheres belong in a CSV file (shape file)";

[[noreturn]] void refuse(const std::string& origin, const std::string& problem) {
  throw InputError(fmt::format("1 problem in {}; nothing was run.\n  {}", origin, problem));
}

/// The first line that is too long, or 0.
std::size_t long_line(std::string_view text) {
  std::size_t line = 1;
  for (std::size_t start = 0; start < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    if (end - start > longest_line) return line;
    start = end + 1;
  }
  return 0;
}

/// The first line with a key of too many parts, or 0. Dots count from one comma or bracket to the
/// next, so tables written inside each other count together; those in texts and comments do not.
std::size_t deep_line(std::string_view text) {
  std::size_t line = 1, dots = 0;
  std::string_view quotes;  // around the text that the place lies in: ", ', """ or '''
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '\n') {
      ++line;
      dots = 0;
      if (quotes.size() == 1) quotes = {};
    } else if (!quotes.empty()) {
      const bool escapes = c == '\\' && quotes.front() == '"';
      if (escapes && text.substr(at + 1, 1) != "\n") {
        ++at;
      } else if (text.substr(at, quotes.size()) == quotes) {
        at += quotes.size() - 1;
        quotes = {};
      }
    } else if (c == '#') {
      at = std::min(text.find('\n', at), text.size()) - 1;
    } else if (c == '"' || c == '\'') {
      quotes = text.substr(at, text.substr(at, 3) == std::string(3, c) ? 3 : 1);
      at += quotes.size() - 1;
    } else if (c == ',' || c == ']') {
      dots = 0;
    } else if (c == '.' && ++dots >= deepest_key) {
      return line;
    }
  }
  return 0;
}

}  // namespace

void check_case_source(std::string_view text, const std::string& origin) {
  if (text.size() > largest_file) refuse(origin, too_large);
  if (const std::size_t line = long_line(text); line > 0)
    refuse(origin, fmt::format("line {} is longer than 1 MiB", line));
  if (const std::size_t line = deep_line(text); line > 0)
    refuse(origin, fmt::format("line {}: a key has more than {} parts", line, deepest_key));
}

std::string read_case_source(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw InputError(path + ": there is no such case file; nothing was run.");
  if (!std::filesystem::is_regular_file(path, ignored))
    throw InputError(path + ": is not a file; nothing was run.");
  if (std::filesystem::file_size(path, ignored) > largest_file) refuse(path, too_large);
  return read_whole_file(path);
}

std::string case_file_of(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    return (std::filesystem::path(path) / "case.toml").string();
  return path;
}

std::string case_name(const std::string& path) {
  const std::filesystem::path file =
      std::filesystem::absolute(case_file_of(path)).lexically_normal();
  const std::string folder = file.parent_path().filename().string(), stem = file.stem().string();
  if (stem == "case") return folder;
  std::error_code ignored;
  const bool variant = std::filesystem::exists(file.parent_path() / "case.toml", ignored);
  return variant && !folder.empty() ? folder + "_" + stem : stem;
}

std::string case_folder(const std::string& path) {
  const std::string folder = std::filesystem::path(case_file_of(path)).parent_path().string();
  return folder.empty() ? "." : folder;
}

}  // namespace breccia
