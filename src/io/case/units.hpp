#pragma once
// Quantities as people write them: "40 mm", "11 GPa", "0.5 mm/s", "30 deg".

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/keys.hpp"

namespace breccia {

/// Powers of mass, length, time and angle, and the factor to SI: factor x 10^tens. The power of ten
/// stays apart so that "9 mm" is the double nearest to 0.009, as 9e-3 is.
struct Unit {
  std::array<int, 4> powers{};  ///< of kg, m, s, rad
  int tens = 0;                 ///< power of ten  [-]
  double factor = 1.0;          ///< what no power of ten states, such as 60 of a minute  [-]
};

/// "kg/m3", "mm/s", "N m", "J/m2", "-", "%": SI prefixes, products, quotients and integer powers.
/// Empty if it is no unit.
std::optional<Unit> parse_unit(std::string_view text);

/// The dimension of a unit in words: "a pressure", "a length"; "[kg m-1 s-2]" if it has no name.
std::string describe_dimension(const Unit& unit);

/// The range of a number that a case gives. A length above 1e9 m is none of a model: squares and
/// cubes of it are no numbers, and others are lost beside it; nor is one below 1e-12 m.
/// @param unit   its SI unit; any but "m": the range as it is
/// @param usual  the value without it; a key that is infinite without it has no bounds
Range given_range(const Range& range, std::string_view unit, double usual);

/// A guess at a number without a unit that is out of its range, as the end of a line: '; did you
/// mean "26 GPa"?' of a modulus, "30 deg" of an angle, "2.4 g/cm3" of a density. Empty if that is
/// out of its range, too.
/// @param number  as text  @param unit  its SI unit
std::string meant_with_unit(const std::string& number, std::string_view unit, const Range& range);

/// A number and its unit, as text, in SI. Units that are powers of ten of SI give the double
/// nearest to the exact value.
/// @param wanted  the unit the value must be convertible to, such as "Pa", or two: "N/m or N"
/// @param problem gets what is wrong, empty if all is well
/// @param better  gets the value as TOML writes it ("30 GPa" in quotes), if one alone can be meant
double parse_quantity(std::string_view text, const std::string& wanted, std::string& problem,
                      std::string* better = nullptr);

}  // namespace breccia
