#pragma once
// Meshes of tetrahedra made by the program gmsh.

#include <cstdint>
#include <string>
#include <vector>

#include "fdem3/setup/body_config.hpp"
#include "prepare/tetrahedra/tet_mesh.hpp"

namespace breccia::prepare {

using FlatCracks = std::vector<fdem3::DiscontinuityConfig>;

/// A box, cylinder or sphere in the language of gmsh.
/// @param cracks  whose planes faces of the mesh lie on; parts of them outside do not count
std::string geo_text(const fdem3::BodyConfig& body, const FlatCracks& cracks);

/// Tetrahedra by gmsh's Delaunay method on one thread: same body, cracks and seed, same bits, for
/// the same version of gmsh.
/// @throws InputError if gmsh is not installed, or what it says if it fails
TetMesh mesh_solid(const fdem3::BodyConfig& body, const FlatCracks& cracks, std::int64_t seed);

/// The inside of a closed surface from an STL file. Where two of its triangles meet at more than 40
/// degrees there is an edge; the rest is meshed anew.
/// @param edge  that is aimed at  [m]
/// @throws InputError naming the file
TetMesh mesh_stl(const std::string& path, double edge, std::int64_t seed);

}  // namespace breccia::prepare
