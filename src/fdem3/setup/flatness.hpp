#pragma once
// How flat the tetrahedra of a mesh are: the flattest one rules the time step.

#include <optional>
#include <string>

#include "fdem3/setup/model.hpp"

namespace breccia::fdem3 {

/// A sentence on the flattest tetrahedron, if it is much flatter than the others.
std::optional<std::string> flat_tetrahedron(const Model& model);

}  // namespace breccia::fdem3
