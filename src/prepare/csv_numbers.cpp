#include "prepare/csv_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>

#include "exec/error.hpp"

namespace breccia::prepare {
namespace {

std::string trimmed(const std::string& text) {
  const char* blank = " \t\r";
  const std::size_t first = text.find_first_not_of(blank);
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// The numbers of a line, if it is nothing else.
std::optional<std::vector<double>> numbers(const std::string& line) {
  std::vector<double> values;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    const std::string word = trimmed(line.substr(at, end - at));
    double value = 0.0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || rest != word.data() + word.size() || !std::isfinite(value))
      return std::nullopt;
    values.push_back(value);
    at = end + 1;
  }
  return values;
}

}  // namespace

void read_csv(const std::string& path, std::size_t count, const std::string& wanted,
              const std::function<bool(const std::vector<double>&)>& take) {
  std::ifstream file(path);
  if (!file) throw IoError(fmt::format("cannot read {}: {}", path, std::strerror(errno)));
  std::string text;
  bool names_may_come = true;
  for (int line = 1; std::getline(file, text); ++line) {
    text = trimmed(text);
    if (text.empty() || text[0] == '#') continue;
    const auto values = numbers(text);
    const bool names = !values && names_may_come;
    names_may_come = false;
    if (names) continue;
    if (!values || values->size() != count || !take(*values))
      throw InputError(fmt::format("{}, line {}: \"{}\" is not {}", path, line, text, wanted));
  }
  if (file.bad()) throw IoError(fmt::format("cannot read {}: {}", path, std::strerror(errno)));
}

}  // namespace breccia::prepare
