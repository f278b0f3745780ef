#pragma once
// --damping of the commands that make specimens of concrete.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>

#include "app/side_by_side_options.hpp"
#include "exec/error.hpp"
#include "laboratory/concrete_tests.hpp"

namespace breccia::app {

/// Local damping of specimens, which their strengths depend on (docs/theory.md, 3).  [-]
inline void add_damping(CLI::App& command, std::optional<double>& damping) {
  command
      .add_option("--damping", damping,
                  "local damping of specimens of concrete by links; default: 0.3, of beams 0.05; "
                  "none with link_damping")
      ->type_name("SHARE")
      ->check(CLI::Range(0.0, 0.95));
}

/// @throws InputError if there is one: the material is none of law concrete
inline void refuse_damping(const std::optional<double>& damping) {
  if (damping)
    throw InputError(
        "--damping: specimens of rock and of law ldpm have none of their own to set; nothing was "
        "run");
}
/// A sample with the damping that was asked for; tells of a drag that cases may not have.
inline laboratory::Sample damped(laboratory::Sample sample, const std::optional<double>& damping) {
  if (sample.material.law == "ldpm") refuse_damping(damping);
  if (damping) sample.damping = *damping;
  const dem::MaterialConfig& m = sample.material;
  if (!damping && m.law == "concrete" && m.link_damping == 0.0)
    tell_notes({fmt::format(
        "material.{}: its links do not damp, so specimens have local damping of {}; a case without "
        "any is weaker, by a tenth to a third in compression. With {}.link_damping = 0.3 nothing "
        "else needs to damp (docs/theory.md, 4)",
        m.name, sample.damping, m.name)});
  return sample;
}

}  // namespace breccia::app
