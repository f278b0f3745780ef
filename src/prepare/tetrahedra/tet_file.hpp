#pragma once
// Meshes of tetrahedra from files.

#include <string>
#include <string_view>

#include "prepare/tetrahedra/tet_mesh.hpp"

namespace breccia::prepare {

/// Reads a mesh: Gmsh 4.1 (.msh, text or binary) or 2.2 (text), or Abaqus (.inp: *NODE, *ELEMENT of
/// type C3D4, and of triangles CPS3, CPE3, S3, S3R, M3D3 and STRI3; *NSET, *ELSET). Physical
/// volumes and element sets become parts; physical surfaces, sets of triangles and node sets become
/// face sets (of a node set: faces of the mesh with all corners in it). Nodes without a tetrahedron
/// are dropped. Tetrahedra that are all turned inside out are turned. Lengths are metres.
/// @throws IoError    if the file cannot be read
/// @throws InputError names file, line and element of what is wrong: all problems of the mesh at
///                    once, or the first thing that cannot be read
TetMesh read_tet_mesh(const std::string& path);

/// Whether a mesh file holds tetrahedra; no, if it cannot be read.
bool holds_tetrahedra(const std::string& path);

/// Read a mesh from a text in memory; `name` stands for the file in messages.
TetMesh parse_tet_gmsh(std::string_view content, const std::string& name);
TetMesh parse_tet_abaqus(std::string_view content, const std::string& name);

}  // namespace breccia::prepare
