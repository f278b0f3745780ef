#pragma once
// Questions to `test` and `calibrate`: targets of a material, from the command line and of the
// named material that it uses, and the case that has it.

#include <string>
#include <vector>

#include "io/case/material_library.hpp"
#include "run/case.hpp"

namespace breccia::app {

/// Targets of the command line ("tension=2.9 MPa"), then of the named material `use`: of two by
/// the same name the first one counts.
/// @throws InputError naming the text that is no target
std::vector<MaterialTarget> all_targets(const std::vector<std::string>& texts,
                                        const std::string& use);

/// The plane case whose rock the laboratory tests: its specimens are spheres or plane.
/// @throws InputError for cases of other methods
const fdem::Config& rock_case(const Case& read);

}  // namespace breccia::app
