#include "io/units.hpp"

#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

namespace breccia {
namespace {

struct NamedUnit {
  std::string_view symbol;
  Unit unit;
  bool takes_prefix;
};

constexpr double pi = 3.14159265358979323846;

const std::vector<NamedUnit>& named_units() {
  static const std::vector<NamedUnit> units{
      {"m", {{0, 1, 0, 0}, 1.0}, true},           {"g", {{1, 0, 0, 0}, 1e-3}, true},
      {"s", {{0, 0, 1, 0}, 1.0}, true},           {"N", {{1, 1, -2, 0}, 1.0}, true},
      {"Pa", {{1, -1, -2, 0}, 1.0}, true},        {"J", {{1, 2, -2, 0}, 1.0}, true},
      {"W", {{1, 2, -3, 0}, 1.0}, true},          {"Hz", {{0, 0, -1, 0}, 1.0}, true},
      {"t", {{1, 0, 0, 0}, 1e3}, false},          {"min", {{0, 0, 1, 0}, 60.0}, false},
      {"h", {{0, 0, 1, 0}, 3600.0}, false},       {"rad", {{0, 0, 0, 1}, 1.0}, true},
      {"deg", {{0, 0, 0, 1}, pi / 180.0}, false}, {"%", {{0, 0, 0, 0}, 0.01}, false},
      {"-", {{0, 0, 0, 0}, 1.0}, false},          {"1", {{0, 0, 0, 0}, 1.0}, false}};
  return units;
}

constexpr std::array<std::pair<std::string_view, double>, 11> prefixes{{{"n", 1e-9},
                                                                        {"u", 1e-6},
                                                                        {"\u00b5", 1e-6},
                                                                        {"m", 1e-3},
                                                                        {"c", 1e-2},
                                                                        {"d", 1e-1},
                                                                        {"h", 1e2},
                                                                        {"k", 1e3},
                                                                        {"M", 1e6},
                                                                        {"G", 1e9},
                                                                        {"T", 1e12}}};

std::optional<Unit> find_symbol(std::string_view symbol) {
  for (const NamedUnit& named : named_units())
    if (named.symbol == symbol) return named.unit;
  for (const auto& [prefix, factor] : prefixes) {
    if (!symbol.starts_with(prefix)) continue;
    for (const NamedUnit& named : named_units())
      if (named.takes_prefix && named.symbol == symbol.substr(prefix.size()))
        return Unit{named.unit.powers, factor * named.unit.factor};
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
  if (symbol.ends_with('^')) symbol.remove_suffix(1);
  std::optional<Unit> unit = find_symbol(symbol);
  if (!unit || power < -9 || power > 9) return std::nullopt;
  double factor = 1.0;
  for (int k = 0; k < std::abs(power); ++k) factor *= unit->factor;
  unit->factor = power < 0 ? 1.0 / factor : factor;
  for (int& p : unit->powers) p *= power;
  return unit;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

std::optional<Unit> parse_unit(std::string_view text) {
  text = trimmed(text);
  if (text.empty()) return std::nullopt;
  Unit product;
  bool below = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("/* ", 1), text.size());
    const std::optional<Unit> factor = parse_power(text.substr(0, end));
    if (!factor) return std::nullopt;
    for (std::size_t k = 0; k < 4; ++k)
      product.powers[k] += below ? -factor->powers[k] : factor->powers[k];
    product.factor = below ? product.factor / factor->factor : product.factor * factor->factor;
    text.remove_prefix(end);
    if (text.empty()) break;
    below = text.front() == '/';
    text = text.front() == ' ' ? trimmed(text) : text.substr(1);
    if (text.empty()) return std::nullopt;
    if (text.front() == '/') {
      below = true;
      text.remove_prefix(1);
    }
    text = trimmed(text);
  }
  return product;
}

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

double parse_quantity(std::string_view text, const std::string& wanted, std::string& problem) {
  problem.clear();
  const std::string_view whole = trimmed(text);
  double value = 0.0;
  const char* const start = whole.data() + (whole.starts_with('+') ? 1 : 0);
  const auto number = std::from_chars(start, whole.data() + whole.size(), value);
  if (number.ec != std::errc{} || !std::isfinite(value)) {
    problem = "\"" + std::string(text) + "\" does not start with a number";
    return 0.0;
  }
  const std::string_view rest =
      trimmed(whole.substr(static_cast<std::size_t>(number.ptr - whole.data())));
  const Unit target = parse_unit(wanted).value_or(Unit{});
  if (rest.empty()) {
    problem = "\"" + std::string(text) + "\" has no unit; write it as a number for " + wanted +
              ", or with a unit";
    return 0.0;
  }
  const std::optional<Unit> unit = parse_unit(rest);
  if (!unit) {
    problem = "'" + std::string(rest) + "' is not a unit";
    return 0.0;
  }
  if (unit->powers != target.powers) {
    problem = "\"" + std::string(text) + "\" is " + describe_dimension(*unit) + ", " +
              describe_dimension(target) + " is wanted, in " + wanted + " or the like";
    return 0.0;
  }
  return value * unit->factor / target.factor;
}

}  // namespace breccia
