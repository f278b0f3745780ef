#pragma once
// Arrays of triangles that lead to others: see fdem_shared/relations.hpp.

#include "fdem/shape.hpp"
#include "fdem_shared/relations.hpp"

namespace breccia::fdem {

using fdem_shared::each_relation;

}  // namespace breccia::fdem
