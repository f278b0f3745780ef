#include "io/case/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "math/constants.hpp"

namespace breccia {
namespace {

struct NamedUnit {
  std::string_view symbol;
  Unit unit;
  bool takes_prefix;
};

const std::vector<NamedUnit>& named_units() {
  static const std::vector<NamedUnit> units{{"m", {{0, 1, 0, 0}}, true},
                                            {"g", {{1, 0, 0, 0}, -3}, true},
                                            {"s", {{0, 0, 1, 0}}, true},
                                            {"N", {{1, 1, -2, 0}}, true},
                                            {"Pa", {{1, -1, -2, 0}}, true},
                                            {"J", {{1, 2, -2, 0}}, true},
                                            {"W", {{1, 2, -3, 0}}, true},
                                            {"Hz", {{0, 0, -1, 0}}, true},
                                            {"rad", {{0, 0, 0, 1}}, true},
                                            {"t", {{1, 0, 0, 0}, 3}, false},
                                            {"min", {{0, 0, 1, 0}, 0, 60.0}, false},
                                            {"h", {{0, 0, 1, 0}, 0, 3600.0}, false},
                                            {"deg", {{0, 0, 0, 1}, 0, pi / 180.0}, false},
                                            {"%", {{0, 0, 0, 0}, -2}, false},
                                            {"-", {}, false},
                                            {"1", {}, false}};
  return units;
}

struct Prefix {
  std::string_view symbol;
  int tens;
};
constexpr std::array<Prefix, 11> prefixes{{{"n", -9},
                                           {"u", -6},
                                           {"\u00b5", -6},
                                           {"m", -3},
                                           {"c", -2},
                                           {"d", -1},
                                           {"h", 2},
                                           {"k", 3},
                                           {"M", 6},
                                           {"G", 9},
                                           {"T", 12}}};

std::optional<Unit> find_symbol(std::string_view symbol) {
  for (const NamedUnit& named : named_units())
    if (named.symbol == symbol) return named.unit;
  for (const auto& [prefix, tens] : prefixes) {
    if (!symbol.starts_with(prefix)) continue;
    for (const NamedUnit& named : named_units())
      if (named.takes_prefix && named.symbol == symbol.substr(prefix.size()))
        return Unit{named.unit.powers, tens + named.unit.tens, named.unit.factor};
  }
  return std::nullopt;
}

/// "m3", "s-2", "m^2"
std::optional<Unit> parse_power(std::string_view text) {
  std::size_t end = text.size();
  while (end > 0 && ((text[end - 1] >= '0' && text[end - 1] <= '9') || text[end - 1] == '-')) --end;
  if (end == 0) end = text.size();
  int power = 1;
  if (end < text.size()) {
    const auto parsed = std::from_chars(text.data() + end, text.data() + text.size(), power);
    if (parsed.ec != std::errc{} || parsed.ptr != text.data() + text.size()) return std::nullopt;
  }
  std::string_view symbol = text.substr(0, end);
  if (end < text.size() && symbol.ends_with('^')) symbol.remove_suffix(1);
  std::optional<Unit> unit = find_symbol(symbol);
  if (!unit || power < -9 || power > 9) return std::nullopt;
  double factor = 1.0;
  for (int k = 0; k < std::abs(power); ++k) factor *= unit->factor;
  unit->factor = power < 0 ? 1.0 / factor : factor;
  unit->tens *= power;
  for (int& p : unit->powers) p *= power;
  return unit;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// The double nearest to a decimal number times a power of ten: the power goes into its exponent.
double times_power_of_ten(std::string_view digits, int tens) {
  const std::size_t e = std::min(digits.find_first_of("eE"), digits.size());
  int exponent = 0;
  if (e < digits.size()) {
    const std::size_t start = digits[e + 1] == '+' ? e + 2 : e + 1;
    std::from_chars(digits.data() + start, digits.data() + digits.size(), exponent);
  }
  const std::string text = std::string(digits.substr(0, e)) + "e" + std::to_string(exponent + tens);
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec == std::errc::result_out_of_range) return std::numeric_limits<double>::quiet_NaN();
  return value;
}

/// Units as people type them, by what they measure; the first of a row is the one in SI.
const std::vector<std::vector<std::string>>& usual_units() {
  static const std::vector<std::vector<std::string>> units{{"m", "nm", "um", "mm", "cm", "km"},
                                                           {"s", "ns", "us", "ms", "min", "h"},
                                                           {"Pa", "kPa", "MPa", "GPa", "N/mm2"},
                                                           {"N", "kN", "MN", "GN"},
                                                           {"J", "kJ", "MJ"},
                                                           {"kg/m3", "g/cm3", "t/m3"},
                                                           {"J/m2", "kJ/m2", "N/m"},
                                                           {"m/s", "mm/s", "km/h"},
                                                           {"m/s2", "mm/s2"},
                                                           {"rad", "deg"},
                                                           {"rad/s", "deg/s"},
                                                           {"kg", "g", "t"},
                                                           {"Hz", "kHz"},
                                                           {"m2", "mm2", "cm2"},
                                                           {"m3", "mm3", "cm3"}};
  return units;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

/// A unit typed in a hurry ("N/mm²", "kg/m**3", "degrees"), as this program writes it.
std::string plain_unit(std::string_view given) {
  static const std::vector<std::pair<std::string_view, std::string_view>> spellings{
      {"\u00b2", "2"}, {"\u00b3", "3"},   {"**", ""},         {"\u00b7", " "},   {"\u03bc", "u"},
      {"\u00b5", "u"}, {"\u00b0", "deg"}, {"degrees", "deg"}, {"degree", "deg"}, {"seconds", "s"},
      {"second", "s"}, {"sec", "s"},      {"metres", "m"},    {"meters", "m"},   {"metre", "m"},
      {"meter", "m"},  {"micron", "um"}};
  std::string text(given);
  for (const auto& [typed, plain] : spellings)
    for (std::size_t at = text.find(typed); at != std::string::npos;
         at = text.find(typed, at + plain.size()))
      text.replace(at, typed.size(), plain);
  return text;
}

/// The unit that was meant by one that is none, or is of another kind, but for its capitals or
/// spelling: "gpa" is "GPa". Empty if more than one may be meant.
std::string respelt(std::string_view given, const Unit& target) {
  const std::string plain = plain_unit(given);
  if (const auto unit = parse_unit(plain); unit && unit->powers == target.powers && plain != given)
    return plain;
  std::string found;
  for (const auto& row : usual_units())
    for (const std::string& unit : row)
      if (lower(unit) == lower(plain) && parse_unit(unit)->powers == target.powers) {
        if (!found.empty()) return "";
        found = unit;
      }
  return found;
}

/// Of a force where a pressure is wanted and the like: "GN", "Pa" give "GPa". Empty otherwise: a
/// metre is no slip for a pascal, nor a kilogram for a kilometre.
std::string with_prefix_of(std::string_view given, const std::string& wanted) {
  constexpr std::array<std::string_view, 3> alike{"N", "Pa", "J"};
  const auto names_load = [&](std::string_view unit) {
    return std::find(alike.begin(), alike.end(), unit) != alike.end();
  };
  constexpr std::string_view large = "kMG";
  const bool prefixed = given.size() > 1 && large.find(given.front()) != std::string_view::npos;
  const std::string prefix(given.substr(0, prefixed ? 1 : 0));
  return names_load(given.substr(prefix.size())) && names_load(wanted) ? prefix + wanted : "";
}

/// A unit that is one, but by a prefix that nobody means: thousandths of a pascal, a thousand
/// kilometres, a million seconds. @returns what was meant, empty for all other units
std::string slip_of_prefix(std::string_view given) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> slips{
      {{"mPa", "MPa"}, {"Mm", "mm"}, {"Ms", "ms"}}};
  for (const auto& [typed, unit] : slips)
    if (given == typed) return std::string(unit);
  return "";
}

/// "Pa, kPa, MPa or GPa"
std::string units_like(const std::string& wanted, const Unit& target) {
  if (wanted == "N/m") return "N/m, kN/m or MN/m";
  if (wanted == "J/m") return "J/m, kJ/m or MJ/m";
  if (wanted == "N m") return "N m, kN m or MN m";
  if (wanted == "N m/m") return "N m/m, kN m/m or N";
  for (const auto& row : usual_units()) {
    if (parse_unit(row.front())->powers != target.powers) continue;
    std::string text = row.front();
    for (std::size_t k = 1; k < row.size(); ++k)
      text += (k + 1 < row.size() ? ", " : " or ") + row[k];
    return text;
  }
  return wanted;
}

}  // namespace

std::optional<Unit> parse_unit(std::string_view text) {
  text = trimmed(text);
  Unit product;
  for (bool below = false;;) {
    const std::size_t end = std::min(text.find_first_of("/* "), text.size());
    const std::optional<Unit> factor = parse_power(text.substr(0, end));
    if (!factor) return std::nullopt;
    for (std::size_t k = 0; k < 4; ++k)
      product.powers[k] += below ? -factor->powers[k] : factor->powers[k];
    product.tens += below ? -factor->tens : factor->tens;
    product.factor = below ? product.factor / factor->factor : product.factor * factor->factor;
    text = trimmed(text.substr(end));
    if (text.empty()) return product;
    below = text.front() == '/';
    if (below || text.front() == '*') text = trimmed(text.substr(1));
  }
}

namespace {

/// Whether a unit is written with newtons: "kN m", "N/m".
bool names_force(std::string_view unit) {
  const std::size_t n = unit.find('N');
  return n != std::string_view::npos && (n + 1 == unit.size() || unit[n + 1] < 'a');
}

/// The quantity of a unit, by the word that stands there: N m and J, N/m and J/m2 are alike.
std::string described(std::string_view written, const Unit& unit) {
  static const Unit torque = *parse_unit("N m"), line = *parse_unit("N/m"),
                    force = *parse_unit("N");
  const std::string_view plain = trimmed(written);
  if (names_force(plain)) {
    if (unit.powers == torque.powers) return "a torque";
    if (unit.powers == line.powers) return "a force per length";
    if (unit.powers == force.powers && plain.find('m') != std::string_view::npos &&
        plain.find('/') != std::string_view::npos)
      return "a torque per length";
  }
  const bool names_energy = plain.find('J') != std::string_view::npos;
  if (names_energy && unit.powers == force.powers) return "an energy per length";
  return describe_dimension(unit);
}

}  // namespace

std::string describe_dimension(const Unit& unit) {
  static const std::vector<std::pair<std::array<int, 4>, const char*>> names{
      {{0, 0, 0, 0}, "a plain number"},
      {{0, 1, 0, 0}, "a length"},
      {{0, 0, 1, 0}, "a time"},
      {{1, 0, 0, 0}, "a mass"},
      {{0, 0, 0, 1}, "an angle"},
      {{0, 1, -1, 0}, "a velocity"},
      {{0, 1, -2, 0}, "an acceleration"},
      {{1, 1, -2, 0}, "a force"},
      {{1, -1, -2, 0}, "a pressure"},
      {{1, 2, -2, 0}, "an energy"},
      {{1, 0, -2, 0}, "an energy per area"},
      {{1, -3, 0, 0}, "a density"},
      {{0, 0, -1, 1}, "an angular velocity"},
      {{0, 0, -1, 0}, "a frequency"},
      {{0, 2, 0, 0}, "an area"},
      {{0, 3, 0, 0}, "a volume"}};
  for (const auto& [powers, name] : names)
    if (powers == unit.powers) return name;
  std::string text = "[";
  constexpr std::array<const char*, 4> symbols{"kg", "m", "s", "rad"};
  for (std::size_t k = 0; k < 4; ++k)
    if (unit.powers[k] != 0)
      text +=
          (text.size() > 1 ? " " : "") + std::string(symbols[k]) + std::to_string(unit.powers[k]);
  return text + "]";
}

double parse_quantity(std::string_view text, const std::string& wanted, std::string& problem,
                      std::string* better) {
  if (const std::size_t cut = wanted.find(" or "); cut != std::string::npos) {
    std::string of_other;
    const double value = parse_quantity(text, wanted.substr(cut + 4), of_other);
    if (of_other.empty()) {
      problem.clear();
      return value;
    }
    return parse_quantity(text, wanted.substr(0, cut), problem, better);
  }
  problem.clear();
  const auto meant = [&](const std::string& value) {
    problem += "; try " + value;
    if (better != nullptr) *better = value;
  };
  const std::string quoted = "\"" + std::string(text) + "\"";
  std::string_view whole = trimmed(text);
  const bool negative = whole.starts_with('-');
  if (const std::string word = lower(whole.substr(negative || whole.starts_with('+') ? 1 : 0));
      word == "inf" || word == "infinity") {
    problem = quoted + " is a text";
    meant(negative ? "-inf" : "inf");
    return 0.0;
  }
  if (whole.starts_with('+')) whole.remove_prefix(1);
  const char* const whole_end = whole.data() + whole.size();
  double value = 0.0;
  const auto number = std::from_chars(whole.data(), whole_end, value);
  if (number.ec != std::errc{} || !std::isfinite(value)) {
    problem = quoted + " does not start with a number";
    return 0.0;
  }
  const std::size_t length = static_cast<std::size_t>(number.ptr - whole.data());
  const std::string_view digits = whole.substr(0, length), rest = trimmed(whole.substr(length));
  const Unit target = parse_unit(wanted).value_or(Unit{});
  if (rest.empty()) {
    problem = quoted + " has no unit; write it as a number for " + wanted + ", or with a unit";
    if (wanted == "-") meant(std::string(digits));
    return 0.0;
  }
  const std::string number_and = "\"" + std::string(digits) + " ";
  if (rest.size() > 1 && rest[0] == ',' && rest[1] >= '0' && rest[1] <= '9') {
    problem = quoted + " has a comma; numbers have a decimal point";
    std::string pointed(whole);
    pointed[length] = '.';
    meant("\"" + pointed + "\"");
    return 0.0;
  }
  const std::optional<Unit> unit = parse_unit(rest);
  if (!unit || unit->powers != target.powers) {
    problem = !unit ? "'" + std::string(rest) + "' is not a unit"
                    : quoted + " is " + described(rest, *unit) + ", " + described(wanted, target) +
                          " is wanted, in " + units_like(wanted, target);
    if (const std::string spelt = respelt(rest, target); !spelt.empty())
      meant(number_and + spelt + "\"");
    else if (const std::string hint = with_prefix_of(rest, wanted); unit && !hint.empty()) {
      // Nobody has a force of 30 GN; 5 kN may be one, which belongs under another key.
      if (hint.starts_with('G'))
        meant(number_and + hint + "\"");
      else
        problem += "; try " + number_and + hint + "\" if that is meant";
    }
    return 0.0;
  }
  const double in_target =
      times_power_of_ten(digits, unit->tens - target.tens) * (unit->factor / target.factor);
  if (const std::string slip = slip_of_prefix(rest); !slip.empty()) {
    problem = fmt::format("{} is {:.6g} {}: {} is {}; if it is meant, write the number in {}",
                          quoted, in_target, wanted, rest,
                          rest == "mPa"  ? "a thousandth of a pascal"
                          : rest == "Mm" ? "a thousand kilometres"
                                         : "a million seconds",
                          wanted);
    meant(number_and + slip + "\"");
    return 0.0;
  }
  return in_target;
}

std::string meant_with_unit(const std::string& number, std::string_view unit, const Range& range) {
  constexpr std::string_view meant[][2] = {{"rad", "deg"}, {"Pa", "GPa"}, {"kg/m3", "g/cm3"}};
  for (const auto& [of, usual] : meant) {
    if (unit != of) continue;
    const std::string text = number + " " + std::string(usual);
    std::string problem;
    if (range.holds(parse_quantity(text, std::string(of), problem)) && problem.empty())
      return "; did you mean \"" + text + "\"?";
  }
  return "";
}

Range given_range(const Range& range, std::string_view unit, double usual) {
  constexpr double least = 1e-12, most = 1e9;
  if (unit != "m" || range.low < 0.0 || std::isinf(usual)) return range;
  const bool above_zero = range.low == 0.0 && (range.open == Open::low || range.open == Open::both);
  Range given = range;
  given.high = std::min(given.high, most);
  if (above_zero) {
    given.low = least;
    given.open = range.open == Open::both ? Open::high : Open::none;
  }
  return given;
}

}  // namespace breccia
