#pragma once
// Particles, tetrahedra and facets of LDPM from the files of public preprocessors.

#include <string>

#include "prepare/ldpm/tessellation.hpp"

namespace breccia::prepare {

struct LdpmMesh {
  std::vector<Vec3> position;           ///<  [m]
  std::vector<double> diameter;         ///< of a grain; 0 on the surface; none with facets  [m]
  std::vector<Tetrahedron> tetrahedra;  ///< sorted; flat ones are left out
  std::vector<LdpmFacet> facets{};      ///< of a file, sorted by (a, b); none: by `facets_of`
};

/// Reads a mesh as Chrono Workbench and the LDPM Workbench of FreeCAD write it, in mm. The end of
/// the path says what is taken from files, all named alike and side by side:
///
///   <name>-data-tets.dat            particles with diameters, and tetrahedra; facets follow
///   <name>-data-facets.dat          particles, tetrahedra, and facets with their area, centroid
///                                   and edge; their corners are in <name>-data-facetsVertices.dat
///   <name>-data-facetsVertices.dat  the same without that file: corners of 12 facets a tetrahedron
///
/// Facets need no diameters: particles and tetrahedra are also taken from <name>-data-nodes.dat, or
/// both from <name>-para-mesh.000.vtk. Empty lines and lines that begin with // or # are passed
/// over.
/// @throws IoError    if a file cannot be read
/// @throws InputError if the path has another end; names file and line of what is no particle,
///                    tetrahedron or facet; names a particle that is the corner of none
LdpmMesh read_ldpm_mesh(const std::string& path);

}  // namespace breccia::prepare
