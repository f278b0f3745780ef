#pragma once
// [material.<name>] use = "...": keys from the materials that the program brings along.

// Text such as "[[[a]]]" meets an assertion of toml++ 3.3 before it is reported as an error; a
// wrong case must not end the program.
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>

#include <vector>

#include "io/case/problems.hpp"

namespace breccia {

/// Gives each table below `material` that has the key `use` the keys of that material, for the
/// method of the case, which it has not itself; tables within it likewise.
/// @param problems  gets names that there are not, and materials that the method has no numbers of
void use_named_materials(toml::table& root, std::vector<Problem>& problems);

}  // namespace breccia
