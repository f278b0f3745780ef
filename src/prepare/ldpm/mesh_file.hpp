#pragma once
// Particles and tetrahedra of LDPM from the files of public preprocessors.

#include <string>

#include "prepare/ldpm/tessellation.hpp"

namespace breccia::prepare {

struct LdpmMesh {
  std::vector<Vec3> position;           ///<  [m]
  std::vector<double> diameter;         ///< of a grain; 0 on the surface  [m]
  std::vector<Tetrahedron> tetrahedra;  ///< sorted; flat ones are left out
};

/// Reads `<name>-data-tets.dat` (four particles a line, counted from 0) and, beside it,
/// `<name>-data-particles.dat` (n, x, y, z, d in mm; d = 0 on the surface), as Chrono Workbench and
/// the LDPM Workbench of FreeCAD write them. Empty lines and lines that begin with // or # are
/// passed over.
/// @param path  of the file of tetrahedra
/// @throws IoError    if a file cannot be read
/// @throws InputError if the path does not end in -data-tets.dat; names file and line of what is no
///                    particle or tetrahedron; names a particle that is the corner of none
LdpmMesh read_ldpm_mesh(const std::string& path);

}  // namespace breccia::prepare
