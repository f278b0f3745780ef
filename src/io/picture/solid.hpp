#pragma once
// Solid bodies of tetrahedra on their way to the canvas: surface, sections of a cut, cracks.

#include <array>
#include <vector>

#include "io/picture/scene.hpp"

namespace breccia {

/// A flat piece of a tetrahedron that may show: a face that looks at the viewer, or the section
/// with the plane of a cut.
struct SolidPiece {
  std::array<ScreenPoint, 4> corner;  ///< around the piece
  std::size_t corners;                ///< 3 or 4; 0: none
  std::int32_t tetrahedron;
  bool section;
};

/// Where a plane cuts a tetrahedron. Corners that lie on the plane count as kept; where no other
/// one is, there is no section: the face of its neighbour below shows.
SolidPiece section_of(const std::array<ScreenPoint, 4>& corners, const ScreenClip& clip);

/// Faces that the frame tells to be exposed, of all tetrahedra, and sections: nothing that shows is
/// missing.
std::vector<SolidPiece> pieces_of(const Frame& frame, const Scene& scene);

/// Lines drawn on bodies: edges of joints that coloring shows, edges of all pieces.
struct SolidMarks {
  bool joints, edges;
};

/// Bodies, and marks on their surface.
void draw_solids(Canvas& canvas, const Frame& frame, const Coloring& coloring, SolidMarks marks,
                 Scene& scene, int threads);

/// The joints that coloring shows, as faces.
void draw_joint_faces(Canvas& canvas, const Frame& frame, const Coloring& coloring, Scene& scene,
                      int threads);

}  // namespace breccia
