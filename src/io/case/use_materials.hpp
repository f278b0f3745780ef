#pragma once
// [material.<name>] use = "...": keys from the materials that the program brings along.

#include <string>
#include <vector>

#include "io/case/problems.hpp"
#include "io/case/toml.hpp"

namespace breccia {

/// Gives each table below `material` that has the key `use` the keys of that material, for the
/// method of the case, which it has not itself; tables within it likewise. A `use` that came by
/// --set where the file has none takes the place of all that the file says there.
/// @param problems  gets names that there are not, and materials that the method has no numbers of
/// @param notes     gets own keys that differ from the material's, and those that were replaced
void use_named_materials(toml::table& root, std::vector<Problem>& problems,
                         std::vector<std::string>& notes);

}  // namespace breccia
