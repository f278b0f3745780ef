#include "app/targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "exec/error.hpp"
#include "io/case/units.hpp"

namespace breccia::app {
namespace {

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
  if (end != value && *end == '\0') return target;  // a plain number is in SI units, as in a case
  std::string problem;
  target.value = parse_quantity(value, target.unit, problem);
  if (!problem.empty()) throw InputError("--target " + text + ": " + problem + "; nothing was run");
  return target;
}

}  // namespace

std::vector<MaterialTarget> all_targets(const std::vector<std::string>& texts,
                                        const std::string& use) {
  std::vector<MaterialTarget> all;
  for (const std::string& text : texts) all.push_back(target_from(text));
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
