#pragma once
// Servos of supports of tetrahedra: see fdem_shared/servos.hpp.

#include "fdem3/world.hpp"
#include "fdem_shared/servos.hpp"

namespace breccia::fdem3 {

using fdem_shared::correct_servos;
using fdem_shared::place_servos;
using fdem_shared::read_servos;

}  // namespace breccia::fdem3
