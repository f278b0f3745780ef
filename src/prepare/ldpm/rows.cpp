#include "prepare/ldpm/rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "exec/error.hpp"
#include "io/whole_file.hpp"

namespace breccia::prepare {
namespace {

constexpr std::string_view blanks = " \t\r";

/// The finite numbers of a line, or none if it holds anything else.
void numbers_of(std::string_view line, std::vector<double>& numbers) {
  numbers.clear();
  for (;;) {
    const std::size_t begin = line.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return;
    const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    double value = 0.0;
    const auto [rest, error] = std::from_chars(line.data() + begin, line.data() + end, value);
    if (error != std::errc{} || rest != line.data() + end || !std::isfinite(value)) {
      numbers.clear();
      return;
    }
    numbers.push_back(value);
    line.remove_prefix(end);
  }
}

}  // namespace

void read_rows(const std::string& path, const std::string& wanted,
               const std::function<bool(const std::vector<double>&, std::size_t line)>& take) {
  const std::string whole = read_whole_file(path);
  std::string_view left = whole;
  std::vector<double> numbers;
  for (std::size_t number = 1; !left.empty(); ++number) {
    const std::size_t end = std::min(left.find('\n'), left.size());
    const std::string_view line = left.substr(0, end);
    left.remove_prefix(std::min(end + 1, left.size()));
    const std::size_t begin = line.find_first_not_of(blanks);
    if (begin == std::string_view::npos || line[begin] == '#' || line.substr(begin, 2) == "//")
      continue;
    numbers_of(line, numbers);
    if (!take(numbers, number))
      throw InputError(fmt::format("{}, line {} is not {}", path, number, wanted));
  }
}

}  // namespace breccia::prepare
