#pragma once
// Targets of a material: from the command line, and of the named material that it uses.

#include <string>
#include <vector>

#include "io/case/material_library.hpp"

namespace breccia::app {

/// Targets of the command line ("tension=2.9 MPa"), then of the named material `use`: of two by
/// the same name the first one counts.
/// @throws InputError naming the text that is no target
std::vector<MaterialTarget> all_targets(const std::vector<std::string>& texts,
                                        const std::string& use);

}  // namespace breccia::app
