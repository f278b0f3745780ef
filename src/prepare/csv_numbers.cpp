#include "prepare/csv_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>

#include "exec/error.hpp"
#include "io/whole_file.hpp"

namespace breccia::prepare {
namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";  ///< of UTF-8; spreadsheets write it

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

/// Whether each field begins as a name does, with a letter, and is no number. Where one begins as a
/// number, the line is of numbers with a slip.
bool is_names(const std::string& line) {
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    const std::string word = trimmed(line.substr(at, end - at));
    const char first = word[word.starts_with('"') ? 1 : 0];  // '\0' if there is none
    double value = 0.0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool number = error != std::errc::invalid_argument && rest == word.data() + word.size();
    const bool letter = std::isalpha(static_cast<unsigned char>(first)) || (first & 0x80) != 0;
    if (!letter || number) return false;
    at = end + 1;
  }
  return true;
}

/// A line in a message.
std::string in_quotes(const std::string& line) {
  constexpr std::size_t most = 80;
  return "\"" + (line.size() > most ? line.substr(0, most) + "..." : line) + "\"";
}

}  // namespace

void read_csv(const std::string& path, std::size_t count, const std::string& wanted,
              const std::function<bool(const std::vector<double>&)>& take) {
  std::istringstream file(read_whole_file(path));
  std::string text;
  bool names_may_come = true;
  bool is_ours = false;  // a line of what is no such file at all is not for everybody's eyes
  for (int line = 1; std::getline(file, text); ++line) {
    if (line == 1 && text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
    text = trimmed(text);
    if (text.empty() || text[0] == '#') continue;
    const bool names = names_may_come && is_names(text);
    names_may_come = false;
    if (names) continue;
    const auto values = numbers(text);
    if (!values || values->size() != count || !take(*values))
      throw InputError(fmt::format(
          "{}, line {}{} is not {}{}", path, line, is_ours ? ": " + in_quotes(text) : "", wanted,
          text.find(';') != std::string::npos
              ? "; it has semicolons: write commas between numbers, and points in them"
              : ""));
    is_ours = true;
  }
}

}  // namespace breccia::prepare
