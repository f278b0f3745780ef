#include "app/targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "exec/error.hpp"
#include "io/case/units.hpp"
#include "math/constants.hpp"

namespace breccia::app {
namespace {

/// The problem of a number that no material has, so that a forgotten unit is told before anything
/// is computed; empty: none.
std::string beyond_materials(const MaterialTarget& target, bool plain) {
  struct Range {
    double low, high;
    const char *words, *unit;  ///< that people write
  };
  const Range range = target.unit == "Pa"    ? Range{1e3, 1e13, "1 kPa to 10 TPa",
                                                  target.name == "young" ? "GPa" : "MPa"}
                      : target.unit == "rad" ? Range{0.0, 0.5 * pi, "0 to 90 degrees", "deg"}
                      : target.unit == "-"   ? Range{0.0, 0.5, "0 to 0.5", ""}
                                             : Range{0.0, 1e9, "0 to 1e9 J/m2", ""};
  if (target.value >= range.low && target.value <= range.high) return "";
  const std::string unit = target.unit == "-" ? "" : " " + target.unit;
  std::string problem = fmt::format("{:g}{} is outside of {}", target.value, unit, range.words);
  if (plain && *range.unit != '\0')
    problem += fmt::format("; did you mean '{:g} {}'?", target.value, range.unit);
  return problem;
}

MaterialTarget target_from(const std::string& text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  MaterialTarget target{text.substr(0, equals), 0.0, target_unit(text.substr(0, equals))};
  if (target.unit.empty() || equals == text.size())
    throw InputError(fmt::format(
        "--target {}: it is not NAME=VALUE with young, poisson, compression, tension, brazilian, "
        "fracture_energy, slide_energy, friction_angle or confinement; nothing was run",
        text));
  const char* const value = text.c_str() + equals + 1;
  char* end = nullptr;
  target.value = std::strtod(value, &end);
  const bool plain = end != value && *end == '\0';  // in SI units, as in a case
  std::string problem;
  if (!plain) target.value = parse_quantity(value, target.unit, problem);
  if (problem.empty()) problem = beyond_materials(target, plain);
  if (!problem.empty()) throw InputError("--target " + text + ": " + problem + "; nothing was run");
  return target;
}

}  // namespace

std::vector<MaterialTarget> all_targets(const std::vector<std::string>& texts,
                                        const std::string& use) {
  std::vector<MaterialTarget> all;
  for (const std::string& text : texts) {
    const MaterialTarget target = target_from(text);
    if (std::any_of(all.begin(), all.end(),
                    [&](const MaterialTarget& other) { return other.name == target.name; }))
      throw InputError(
          fmt::format("--target {}: {} is asked for twice; nothing was run", text, target.name));
    all.push_back(target);
  }
  if (const NamedMaterial* const named = use.empty() ? nullptr : named_material(use))
    all.insert(all.end(), named->targets.begin(), named->targets.end());
  return all;
}

const fdem::Config& rock_case(const Case& read) {
  if (const auto* const plane = std::get_if<fdem::Config>(&read.config)) return *plane;
  throw InputError(fmt::format(
      "{}: specimens are made for method = \"dem3d\" and method = \"fdem2d\"; nothing was run\n"
      "  name a plane case that has the same material: its laws and numbers mean the same",
      read.file.empty() ? read.name : read.file));
}

}  // namespace breccia::app
