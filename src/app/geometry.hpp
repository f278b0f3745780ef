#pragma once
// Meshes and packings of files and results, to be told about or written in another format.

#include <cstdint>
#include <string>
#include <vector>

#include "math/vec.hpp"
#include "prepare/meshing/mesh.hpp"
#include "prepare/tetrahedra/tet_mesh.hpp"

namespace breccia::app {

/// A mesh of triangles or tetrahedra, or a packing of spheres.
struct Geometry {
  prepare::Mesh mesh;      ///< no triangles: none
  prepare::TetMesh solid;  ///< no tetrahedra: none
  std::vector<Vec3> center;
  std::vector<double> radius;       ///<  [m]
  std::vector<std::string> groups;  ///< names of bodies
  std::vector<std::int32_t> group;  ///< of each sphere, index into groups; empty: not told

  bool is_mesh() const { return !mesh.triangle.empty(); }
  bool is_solid() const { return !solid.tetrahedron.empty(); }
};

/// Reads a mesh (.msh, .inp), spheres (.csv, .txt, a dump of LAMMPS or LIGGGHTS), a prepared model
/// (.br), or a frame of a result folder.
/// @param frame  of a result folder; -1: the last
/// @throws IoError or InputError, as the reader of that format does
Geometry read_geometry(const std::string& path, int frame = -1);

/// Bytes of a file, by the end of its name: .msh (Gmsh 2.2), .inp (Abaqus), .vtu, .hdf (VTKHDF); of
/// spheres .csv (x,y,z,radius and the body's name as a comment), .vtu or .hdf.
/// @throws InputError if the name ends otherwise, or the format holds no such geometry
std::string written_geometry(const Geometry& geometry, const std::string& name);

}  // namespace breccia::app
