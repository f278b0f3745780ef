#pragma once
// Spheres from a CSV file.

#include <string>
#include <vector>

#include "math/vec.hpp"

namespace breccia::prepare {

struct Spheres {
  std::vector<Vec3> position;  ///<  [m]
  std::vector<double> radius;  ///<  [m]
};

/// Lines of x,y,z,radius in metres; empty lines, lines that start with # and a first line of names
/// are passed over. Blanks may stand for commas, as YADE's export.text writes. A dump of LAMMPS or
/// LIGGGHTS ("ITEM: ATOMS" with x, y, z and radius or diameter among its columns) gives its last
/// snapshot; a data file of LAMMPS its atoms of style sphere.
/// @throws IoError    if the file cannot be read
/// @throws InputError names file and line if a line is not four numbers, the last one positive
Spheres read_spheres(const std::string& path);

}  // namespace breccia::prepare
