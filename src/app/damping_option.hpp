#pragma once
// --damping of the commands that make specimens of concrete.

#include <CLI/CLI.hpp>
#include <optional>

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
/// A sample with the damping that was asked for.
inline laboratory::Sample damped(laboratory::Sample sample, const std::optional<double>& damping) {
  if (sample.material.law == "ldpm") refuse_damping(damping);
  if (damping) sample.damping = *damping;
  return sample;
}

}  // namespace breccia::app
