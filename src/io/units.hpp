#pragma once
// Quantities as people write them: "40 mm", "11 GPa", "0.5 mm/s", "30 deg".

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace breccia {

/// Powers of mass, length, time and angle, and the factor to SI.
struct Unit {
  std::array<int, 4> powers{};  ///< of kg, m, s, rad
  double factor = 1.0;          ///< times this is SI
};

/// "kg/m3", "mm/s", "N m", "J/m2", "-", "%": SI prefixes, products, quotients and integer powers.
/// Empty if it is no unit.
std::optional<Unit> parse_unit(std::string_view text);

/// What a unit measures, for people: "a pressure", "a length"; "[kg m-1 s-2]" if it has no name.
std::string describe_dimension(const Unit& unit);

/// A number and its unit, as text, in SI.
/// @param wanted  the unit the value must be convertible to, such as "Pa"
/// @param problem gets what is wrong, empty if all is well
double parse_quantity(std::string_view text, const std::string& wanted, std::string& problem);

}  // namespace breccia
