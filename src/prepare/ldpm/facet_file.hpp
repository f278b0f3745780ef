#pragma once
// Facets of LDPM from the files of public preprocessors.

#include <string>
#include <vector>

#include "prepare/ldpm/tessellation.hpp"

namespace breccia::prepare {

/// Reads the facets of tetrahedra, 12 each. Those of flat tetrahedra are left out.
///
/// A row of <name>-data-facets.dat: tetrahedron, three rows of <name>-data-facetsVertices.dat,
/// volume between the facet and the two particles, projected area, centroid (3), unit vector along
/// the edge (3), two unit vectors across it (6), flag of the material; counted from 0. Vectors
/// across the edge have no use: the law is isotropic there.
///
/// @param name        of the files, with their folder
/// @param described   false: only <name>-data-facetsVertices.dat is read, three rows a facet and 12
///                    facets a tetrahedron in its order; areas, centroids and edges follow
/// @param tetrahedra  in the order of their file  [-]
/// @param flat        which of them are
/// @throws InputError names file and line of a facet that belongs to no edge of its tetrahedron,
///                    whose volume or area is not that of its corners, or of a second material;
///                    names a tetrahedron that has not 12 facets
std::vector<LdpmFacet> read_ldpm_facets(const std::string& name, bool described,
                                        const std::vector<Vec3>& position,
                                        const std::vector<Tetrahedron>& tetrahedra,
                                        const std::vector<bool>& flat);

}  // namespace breccia::prepare
