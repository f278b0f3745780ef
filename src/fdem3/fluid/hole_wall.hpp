#pragma once
// The wall of a hole in tetrahedra.

#include <array>
#include <vector>

#include "exec/types.hpp"

namespace breccia::fdem3 {

/// The wall of a hole, as faces of tetrahedra that meet in vertices. Where its region ends, as at
/// the collar of a borehole, the wall has a rim, which a flat cap closes.
struct HoleWall {
  std::vector<Index> faces;  ///< 4 tetrahedron + k of the whole mesh, ascending  [-]
  std::vector<std::array<Index, 3>> corner;  ///< of each face, among the hole's own vertices  [-]
  Index vertices = 0;                        ///< how many there are  [-]
  std::vector<std::array<Index, 2>> rim;  ///< its edges there, in the direction of their face  [-]
  std::vector<Index> cap;                 ///< of each of them, which one closes it  [-]
  Index caps = 0;                         ///< how many there are  [-]
};

inline const std::vector<Index>& sides_of_hole(const HoleWall& hole) {
  return hole.faces;
}

}  // namespace breccia::fdem3
