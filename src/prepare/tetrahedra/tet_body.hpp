#pragma once
// The mesh of one body of the FDEM in three dimensions.

#include <cstdint>
#include <string>
#include <vector>

#include "fdem3/setup/body_config.hpp"
#include "prepare/shapes/solid.hpp"
#include "prepare/tetrahedra/tet_gmsh.hpp"
#include "prepare/tetrahedra/tet_mesh.hpp"

namespace breccia::prepare {

/// Data of the case, besides its own keys, that a body's mesh depends on.
struct TetContext {
  std::int64_t seed = 1;
  std::uint32_t number = 0;  ///< of the body: streams of random numbers
  std::string folder;        ///< of the files
  FlatCracks cracks;         ///< that meshes made by gmsh follow
};

/// The directions of a body's own axes: turned about its centre.
Frame3 frame_of(const fdem3::BodyConfig& body);

/// Meshes, turns, moves to its centre and jitters a body.
/// @throws InputError that does not name the body
TetMesh mesh_of(const fdem3::BodyConfig& body, const TetContext& context);

/// Whether the body's mesh is made by gmsh.
bool needs_gmsh(const fdem3::BodyConfig& body);

/// Whether the body's mesh is made to follow cracks.
bool follows_cracks(const fdem3::BodyConfig& body);

/// Whether a point lies in a body of shape "part".
bool in_part(const fdem3::BodyConfig& part, const Vec3& point);

/// The tetrahedra of a mesh that are a body: those of its parts, or all.
/// @throws InputError if the mesh has no part of a name
std::vector<Index> tetrahedra_of(const fdem3::BodyConfig& body, const TetMesh& mesh);

}  // namespace breccia::prepare
