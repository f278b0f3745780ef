#pragma once
// Servos of supports of triangles: see fdem_shared/servos.hpp.

#include "fdem/world.hpp"
#include "fdem_shared/servos.hpp"

namespace breccia::fdem {

using fdem_shared::correct_servos;
using fdem_shared::place_servos;
using fdem_shared::read_servos;

}  // namespace breccia::fdem
