#pragma once
// A model of spheres and tetrahedra.

#include "dem/setup/model.hpp"
#include "fdem3/setup/model.hpp"

namespace breccia::coupled {

struct Model {
  dem::Model spheres;
  fdem3::Model tetrahedra;
};

}  // namespace breccia::coupled
