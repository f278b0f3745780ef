#include "report/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string_view>

#include "exec/error.hpp"
#include "io/case/suggestion.hpp"
#include "io/case/units.hpp"
#include "io/whole_file.hpp"

namespace breccia::report {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr const char* blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Fields of a line; one in quotes may hold the separator, and a quote written twice.
std::vector<std::string> fields_of(std::string_view line, char separator) {
  std::vector<std::string> fields{""};
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"')
        fields.back() += line[++i];
      else
        quoted = !quoted;
    } else if (c == separator && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  for (std::string& field : fields) field = std::string(trimmed(field));
  return fields;
}

/// A number, or nothing if the text is none. An empty field is a gap.
std::optional<double> number_in(std::string text, char separator) {
  if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
  if (separator != ',') std::replace(text.begin(), text.end(), ',', '.');
  const char* const begin = text.data() + (text.front() == '+' ? 1 : 0);
  double value = 0.0;
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

struct Line {
  int number;  ///< in the file, from 1
  std::vector<std::string> fields;
};

struct Lines {
  char separator = ',';
  std::vector<Line> lines;
  bool ends_with_newline = true;
};

Lines lines_of(const std::string& path, bool measured) {
  const std::string file = read_whole_file(path, std::uint64_t{1} << 30);
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  std::string_view content(file);
  if (content.starts_with(byte_order_mark)) content.remove_prefix(byte_order_mark.size());
  Lines all;
  all.ends_with_newline = content.empty() || content.back() == '\n';
  int number = 0;
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    const std::string_view line = content.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    const std::string_view inside = trimmed(line);
    if (measured && (inside.empty() || inside.front() == '#')) continue;
    if (all.lines.empty() && measured)
      all.separator = line.find(';') != std::string_view::npos    ? ';'
                      : line.find('\t') != std::string_view::npos ? '\t'
                                                                  : ',';
    all.lines.push_back({number, fields_of(line, all.separator)});
  }
  return all;
}

bool all_numbers(const Line& line, char separator) {
  return std::all_of(line.fields.begin(), line.fields.end(), [&](const std::string& field) {
    return number_in(field, separator).has_value();
  });
}

/// Moves a unit that stands behind the name in brackets to its own place.
void split_name(Column& column) {
  const std::string& name = column.name;
  if (name.empty() || (name.back() != ']' && name.back() != ')')) return;
  const std::size_t open = name.rfind(name.back() == ']' ? '[' : '(');
  if (open == std::string::npos) return;
  column.unit = std::string(trimmed(name.substr(open + 1, name.size() - open - 2)));
  column.name = std::string(trimmed(name.substr(0, open)));
}

/// Numbers become SI. @throws InputError where the unit is none
void to_si(const std::string& path, Column& column) {
  if (column.unit.empty()) return;
  const std::optional<Unit> unit = parse_unit(column.unit);
  if (!unit) {
    static const std::set<std::string> usual{
        "m",   "mm",  "um", "s",  "ms", "us",  "min",  "N",   "kN",  "MN", "Pa",  "kPa",
        "MPa", "GPa", "J",  "kg", "g",  "m/s", "mm/s", "deg", "rad", "%",  "N/m", "kN/m"};
    throw InputError(fmt::format(
        "{}: \"{}\", the unit of column {}, is no unit{}; allowed are units as of case files, such "
        "as {}; without brackets and without a line of units a column is drawn as it is",
        path, column.unit, column.name, suggestion(column.unit, usual),
        fmt::join(std::vector<const char*>{"mm", "ms", "kN", "MPa", "mm/s", "%", "-"}, ", ")));
  }
  for (const char* known : {"m", "s", "N", "Pa", "J", "kg", "m/s", "m/s2", "N/m", "J/m2", "J/m",
                            "rad", "N m", "1/s", "-"}) {
    if (parse_unit(known)->powers != unit->powers) continue;
    const double factor = unit->factor * std::pow(10.0, unit->tens);
    for (double& value : column.values) value *= factor;
    column.unit = known;
    return;
  }
}

NumberTable table_of(const std::string& path, const Lines& all, bool measured) {
  NumberTable table;
  if (all.lines.empty()) return table;
  const Line& names = all.lines.front();
  if (measured && all_numbers(names, all.separator))
    throw InputError(fmt::format(
        "{}:{}: the first line must hold the names of the columns, as in time [s], force [kN]",
        path, names.number));
  for (const std::string& name : names.fields) table.columns.push_back({name, "", {}});
  std::size_t next = 1;
  if (all.lines.size() > 1 && !all_numbers(all.lines[1], all.separator) &&
      all.lines[1].fields.size() == table.columns.size() &&
      !number_in(all.lines[1].fields.front(), all.separator)) {
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      table.columns[c].unit = all.lines[1].fields[c];
    next = 2;
  }
  for (; next < all.lines.size(); ++next) {
    const Line& line = all.lines[next];
    const bool last = next + 1 == all.lines.size();
    if (!measured && last && !all.ends_with_newline) break;
    if (line.fields.size() != table.columns.size())
      throw InputError(fmt::format("{}:{}: {} fields, but the first line names {} columns", path,
                                   line.number, line.fields.size(), table.columns.size()));
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (table.columns[c].unit == "name") continue;
      const std::optional<double> value = number_in(line.fields[c], all.separator);
      if (!value)
        throw InputError(
            fmt::format("{}:{}: \"{}\" is no number", path, line.number, line.fields[c]));
      table.columns[c].values.push_back(*value);
    }
  }
  std::erase_if(table.columns, [](const Column& c) { return c.unit == "name"; });
  return table;
}

}  // namespace

const Column* NumberTable::column(const std::string& name) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

NumberTable read_table(const std::string& path) {
  return table_of(path, lines_of(path, false), false);
}

NumberTable read_measured(const std::string& path) {
  NumberTable table = table_of(path, lines_of(path, true), true);
  if (table.columns.size() < 2 || table.rows() == 0)
    throw InputError(path +
                     ": measurements need a line of names, then lines of at least two numbers: x "
                     "and what was measured there");
  for (Column& column : table.columns) {
    if (column.unit.empty()) split_name(column);
    to_si(path, column);
  }
  return table;
}

}  // namespace breccia::report
