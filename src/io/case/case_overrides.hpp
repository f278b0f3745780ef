#pragma once
// Keys of a case that the command line replaces.

#include <string>

#include "io/case/toml.hpp"

namespace breccia {

/// Puts a value in its place in a case, as `--set body.slab.velocity=[0, 0, 1]` asks; an item of a
/// list goes by its name or its number from 0.
/// @param text  KEY=VALUE; the value is TOML, or else a text
/// @throws InputError if it has no such place
void apply_override(toml::table& root, const std::string& text);

}  // namespace breccia
