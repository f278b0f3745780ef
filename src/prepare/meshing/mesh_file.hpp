#pragma once
// Meshes of triangles from files.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "math/vec.hpp"
#include "prepare/meshing/mesh.hpp"

namespace breccia::prepare {

/// Reads a mesh: Gmsh 4.1 (.msh, text or binary) or 2.2 (text), or Abaqus (.inp: *NODE, *ELEMENT of
/// types CPS3, CPE3, S3, S3R, M3D3 and STRI3, of quadrangles CPS4, CPE4, CPS4R, CPE4R, S4, S4R and
/// M3D4, and of lines T2D2, T3D2, B21 and B31; *NSET, *ELSET). A quadrangle becomes four triangles
/// around its middle.
/// Physical surfaces and element sets become parts; physical lines, sets of line elements and node
/// sets become edge sets (of a node set: edges of the mesh with both ends in it). Lengths are
/// metres.
/// @param seams  nodes may lie at one place and triangles share no edge with any other
/// @throws IoError    if the file cannot be read
/// @throws InputError names file, line and element of what is wrong: all problems of the mesh at
///                    once, or the first thing that cannot be read
Mesh read_mesh(const std::string& path, bool seams = false);

/// Read a mesh from a text in memory; `name` stands for the file in messages.
Mesh parse_gmsh(std::string_view content, const std::string& name, bool seams = false);
Mesh parse_abaqus(std::string_view content, const std::string& name, bool seams = false);

/// Contents of a file, with its own numbers, before references are resolved. Elements are triangles
/// of a plane mesh, tetrahedra of one in space; sides are lines or triangles that name edges or
/// faces of elements.
struct RawMesh {
  struct Node {
    std::int64_t number;
    Vec3 position;  ///<  [m]
    int line;       ///< of the file; 0: a binary file
  };
  struct Element {
    std::int64_t number;
    std::array<std::int64_t, 4> nodes;  ///< fewer for a triangle or line
    int line;
  };
  std::vector<Node> nodes;
  std::vector<Element> elements, sides;
  std::vector<Element> quadrangles;       ///< four of the elements each, around a node of their own
  std::vector<std::int64_t> other_nodes;  ///< of elements that are neither
  std::map<std::string, std::vector<std::size_t>> parts;       ///< positions in elements
  std::map<std::string, std::vector<std::size_t>> side_sets;   ///< positions in sides
  std::map<std::string, std::vector<std::int64_t>> node_sets;  ///< numbers
};
/// Adds a quadrangle of a plane mesh as four triangles in turn around the node -1, -2, ..., which
/// has no place yet.
void add_quadrangle(RawMesh& raw, const RawMesh::Element& quadrangle);

/// @param dimension  2: a mesh of triangles, 3: of tetrahedra
/// @throws InputError for the first thing that cannot be read
RawMesh raw_gmsh(std::string_view content, const std::string& name, int dimension);
RawMesh raw_abaqus(std::string_view content, const std::string& name, int dimension);

/// Looks everything up in a plane mesh, places the middles of quadrangles, and checks it. @throws
/// InputError with all problems, each with its line
Mesh finished_mesh(RawMesh raw, const std::string& name, bool seams);

}  // namespace breccia::prepare
