#pragma once
// A model of deformable tetrahedra on the host, ready to be set up.

#include <array>
#include <string>
#include <vector>

#include "exec/types.hpp"
#include "math/vec.hpp"

namespace breccia::fdem3 {

/// Model of a case: prepare makes it, fdem3/setup turns it into a world. Element t has global id t.
/// Tetrahedra that share three vertices are neighbours; set-up joins them where a joint law is
/// given for their materials, and splits the mesh, so that each tetrahedron owns its four nodes.
struct Model {
  std::vector<Vec3> point;                        ///< vertices  [m]
  std::vector<std::array<Index, 4>> tetrahedron;  ///< corners into point: the last one sees the
                                                  ///< first three run counter-clockwise from
                                                  ///< inside, det(x1 - x0, x2 - x0, x3 - x0) > 0
  std::vector<std::string> groups;                ///< names of the bodies
  std::vector<std::int16_t> group;                ///< of each tetrahedron, index into groups
  std::vector<std::int16_t> material;  ///< of each tetrahedron, index into Config::materials
  std::vector<Vec3> velocity;          ///< of each tetrahedron at the start  [m/s]
  std::vector<float> strength;         ///< of each tetrahedron, over its material's  [-]

  /// A set of faces with a name: physical surfaces of a mesh file.
  struct FaceSet {
    std::string name;
    std::vector<std::array<Index, 3>> faces;  ///< vertices, ascending
  };
  std::vector<FaceSet> face_sets;

  /// A face of a discontinuity: its joint is broken at the start, or has a law of its own.
  struct Discontinuity {
    std::array<Index, 3> face;  ///< vertices, ascending
    std::int16_t material;      ///< of its joint, index into Config::joint_laws; -1: open
  };
  std::vector<Discontinuity> discontinuities;

  Index size() const { return static_cast<Index>(tetrahedron.size()); }
};

}  // namespace breccia::fdem3
