#pragma once
// Arrays of tetrahedra that lead to others: see fdem_shared/relations.hpp.

#include "fdem3/shape.hpp"
#include "fdem_shared/relations.hpp"

namespace breccia::fdem3 {

using fdem_shared::each_relation;

}  // namespace breccia::fdem3
